#pragma once

#include <cstdint>

#include "analysis/geometry/grid.h"
#include "analysis/skeleton/graph.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The effect of the visibility-aware map, in voxels.
struct SightReport {
  std::uint64_t mapped = 0;       ///< voxels with a node
  std::uint64_t seen_before = 0;  ///< voxels that see their geodesically nearest node
  std::uint64_t seen_after = 0;   ///< voxels that see their node of the new map
};

/// Number of nodes besides its own that a voxel tests.
inline constexpr int sight_candidates = 32;

/// The visibility-aware variant of the node mapping grid that Noel 2015, 7.4.2.1, calls for:
/// changes node_map()'s `map` of this graph so that each voxel is mapped to the geodesically
/// nearest node that it sees (sees()). A voxel that sees its nearest node keeps it. Any other takes
/// the nearest that it sees among nodes around its own in the graph (at most sight_candidates,
/// denser near by); to a node in sight the distance over faces is the L1 distance, up to single
/// steps around corners. A voxel that sees none of them keeps its nearest node. The same for any
/// number of threads. `l1` is l1_distance() of the domain. Throws std::invalid_argument if the
/// grids differ in size.
SightReport prefer_visible_nodes(Grid3<std::uint32_t>& map, const SkeletonGraph& graph,
                                 const Grid3<std::uint16_t>& l1, const ThreadPool& pool);

}  // namespace lacuna
