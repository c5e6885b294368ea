#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of meshes that lie closer to another one, on the side that both face, than the distance at
/// which rays start off its surface (ray_offset.h): light passes between them, and a shadow is
/// lost. On a tilted triangle that distance is about 2^-22 of its size, elsewhere about 2^-22 of
/// the coordinates. Looks at some triangles of each mesh, at their centres. One text, or none.
std::vector<std::string> close_surfaces(const Scene& scene);

}  // namespace lacuna
