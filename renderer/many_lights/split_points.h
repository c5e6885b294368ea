#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/path/record_tree.h"

namespace lacuna {

/// Splits points into at most `parts` >= 1 groups of similar position and normal, and returns each
/// group's indices into `points`. The largest group is split next, at the middle of the longest
/// side of its 6-D bounding box of position / `radius` and normal (Nabata et al., 3.1); `radius` is
/// in scene units. Groups of identical points are not split.
std::vector<std::vector<std::uint32_t>> split_points(std::span<const SurfacePoint> points,
                                                     std::size_t parts, float radius);

}  // namespace lacuna
