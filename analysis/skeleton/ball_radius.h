#pragma once

#include <cstdint>

#include "analysis/geometry/grid.h"

namespace lacuna {

/// The squared radius of the largest open ball around a lattice corner of the grid that meets no
/// closed cube of the scene: voxels of L1 distance 0, and everything outside the grid. Exact; 0 if
/// the corner touches the scene. `l1` is the result of l1_distance(), which bounds the search, so
/// no Euclidean map is needed.
std::int64_t squared_ball_radius(const Grid3<std::uint16_t>& l1, Imath::V3i corner);

}  // namespace lacuna
