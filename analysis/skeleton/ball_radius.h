#pragma once

#include <cstdint>

#include "analysis/geometry/grid.h"

namespace lacuna {

/// The square of the radius of the largest open ball around a lattice corner of the grid that meets
/// no closed cube of the scene: voxels where the L1 distance is 0, and all outside the grid. Exact;
/// 0 if the corner touches the scene. `l1` is what l1_distance() gives: it bounds the search, so
/// that no Euclidean map is needed.
std::int64_t squared_ball_radius(const Grid3<std::uint16_t>& l1, Imath::V3i corner);

}  // namespace lacuna
