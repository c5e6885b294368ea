#pragma once

#include <cstdint>

#include "analysis/geometry/grid.h"

namespace lacuna {

/// Whether the straight line from the centre of a voxel of the domain to a lattice corner
/// intersects no closed cube of a voxel with L1 distance 0, except at the corner itself, which may
/// touch the scene. So it is false through every wall, also one of diagonal voxels. Exact, in
/// integers; the distances let it skip empty space. Voxel and corner must lie in the grid.
/// `squared_radius`: of an empty ball around the corner, as squared_ball_radius() returns it, which
/// the test does not enter. Sides of the grid up to 2^19.
bool sees(const Grid3<std::uint16_t>& l1, Imath::V3i voxel, Imath::V3i corner,
          std::int64_t squared_radius = 0);

}  // namespace lacuna
