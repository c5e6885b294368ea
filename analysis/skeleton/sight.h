#pragma once

#include <cstdint>

#include "analysis/geometry/grid.h"

namespace lacuna {

/// Whether the straight line from the centre of a voxel of the domain to a lattice corner stays
/// clear of the scene: meets no closed cube of a voxel with L1 distance 0, the corner itself left
/// out (it may touch the scene). So it is never true through a wall, be it one of diagonal voxels.
/// Exact, in whole numbers; the distances let it skip empty space. Voxel and corner must lie in the
/// grid. `squared_radius` may name a ball around the corner that is known to be clear, as
/// squared_ball_radius() gives it: the line is not followed into it. Sides of the grid up to 2^19.
bool sees(const Grid3<std::uint16_t>& l1, Imath::V3i voxel, Imath::V3i corner,
          std::int64_t squared_radius = 0);

}  // namespace lacuna
