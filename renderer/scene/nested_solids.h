#pragma once

#include <string>
#include <vector>

#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of transmitting solids that lie in others, since light between them is refracted as if air
/// were there, and of other meshes in solids that absorb, since light between two of these is not
/// weakened. Follows a ray outwards from one triangle of each of at most 4096 meshes of both kinds.
std::vector<std::string> nested_solids(const Scene& scene);

/// Warns of a camera in a solid that absorbs: light between it and other meshes in there is not
/// weakened.
std::vector<std::string> camera_in_solid(const Scene& scene, const Camera& camera);

}  // namespace lacuna
