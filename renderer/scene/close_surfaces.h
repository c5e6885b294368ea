#pragma once

#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace lacuna {

/// Warns of meshes that lie closer to another mesh, on the side that both face, than the offset at
/// which rays start (ray_offset.h): light leaks between them, and a shadow is lost. The offset is
/// about 2^-22 of the size of a tilted triangle, otherwise about 2^-22 of the coordinates. Tests
/// the centres of some triangles of each mesh. Returns at most one text.
std::vector<std::string> close_surfaces(const Scene& scene, const ThreadPool& pool);

}  // namespace lacuna
