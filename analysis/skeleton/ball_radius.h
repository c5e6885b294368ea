#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "analysis/geometry/grid.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The squared radius of the largest open ball around a lattice corner of the grid that meets no
/// closed cube of the scene: voxels of L1 distance 0, and everything outside the grid. Exact; 0 if
/// the corner touches the scene. `l1` is the result of l1_distance(), which bounds the search, so
/// no Euclidean map is needed.
std::int64_t squared_ball_radius(const Grid3<std::uint16_t>& l1, Imath::V3i corner);

/// squared_ball_radius() of each of `corners`.
std::vector<std::int64_t> squared_ball_radii(const Grid3<std::uint16_t>& l1,
                                             std::span<const Imath::V3i> corners,
                                             const ThreadPool& pool);

/// The largest value of `squares`, the result of squared_distance(), among the voxels of the grid
/// that meet at a lattice corner. Noel 2015, 6.3, takes the radius of a node from a Euclidean
/// distance map "at each node coordinate"; a node is a vertex, and this is how 6.2.2 extends a
/// distance map of voxels to all faces of the complex (D_1^cc). So a node has at least radius 1, on
/// whichever side of a passage one voxel wide the collapse leaves it. The author's code reads the
/// voxel whose index the node has. His collapse leaves the low corner of such passages, where both
/// readings give 1 (on his grids of door of 118 and 234 voxels at 558 of 563 nodes); ours leaves
/// the high corner, where that voxel is scene (at 531 of the 1444 nodes at 234 voxels).
std::int64_t squared_voxel_radius(const Grid3<std::uint32_t>& squares, Imath::V3i corner);

}  // namespace lacuna
