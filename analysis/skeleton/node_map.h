#pragma once

#include <cstdint>

#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/grid.h"
#include "analysis/parallel/thread_pool.h"
#include "analysis/skeleton/graph.h"

namespace lacuna {

/// The node mapping grid (Noel 2015, 6.4, Alg. 5): of each voxel of the domain the nearest node,
/// along paths of voxels that share faces; no_node outside the domain. The same for any number of
/// threads. Decided here, where the text leaves it open:
/// - Among nodes equally near, a voxel takes that of a neighbour one step nearer: of the first of
///   them in the order -x, +x, -y, +y, -z, +z. Only in such ties can it differ from the thesis'
///   queue, where the order of the nodes decides.
/// - A node starts from all voxels of the domain that touch its lattice corner, at distance 0: the
///   corner may be all that joins them. A voxel of several nodes is that of the first.
/// - Domains are connected through shared edges and corners of voxels. What paths over faces do not
///   reach is entered last, over an edge or a corner, and filled from there.
/// Only a component of the domain without any node keeps no_node. Linear time. Throws
/// std::invalid_argument if a node's corner lies outside the grid, MemoryLimitError if it would
/// take more than `byte_limit` bytes.
Grid3<std::uint32_t> node_map(const BitGrid3& domain, const SkeletonGraph& graph,
                              const ThreadPool& pool, std::uint64_t byte_limit);

}  // namespace lacuna
