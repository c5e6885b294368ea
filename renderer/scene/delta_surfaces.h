#pragma once

#include <string>
#include <vector>

#include "renderer/scene/camera.h"
#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of mirrors, clear glass and smooth coats that the camera sees, for methods whose light
/// paths are connected to the eye: no connection follows a delta lobe, so what such a surface shows
/// is missing. A grid of camera rays is looked at. Requires SceneNeeds::materials.
std::vector<std::string> missing_reflections(const Scene& scene, const Camera& camera);

}  // namespace lacuna
