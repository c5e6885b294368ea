#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/path/record_tree.h"

namespace lacuna {

/// Splits places into at most `parts` >= 1 groups of places that lie near one another and face the
/// same way, and returns the members of each as indices into `points`. The group of most members is
/// split next, at the middle of the longest side of its 6-D box of position and normal (Nabata et
/// al., 3.1); positions are measured in `radius`, scene units. Groups whose places are all alike
/// stay whole.
std::vector<std::vector<std::uint32_t>> split_points(std::span<const SurfacePoint> points,
                                                     std::size_t parts, float radius);

}  // namespace lacuna
