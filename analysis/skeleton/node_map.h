#pragma once

#include <cstdint>

#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/grid.h"
#include "analysis/skeleton/graph.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The node mapping grid (Noel 2015, 6.4, Alg. 5): the nearest node of each voxel of the domain,
/// along paths of voxels that share faces; no_node outside the domain. The same for any number of
/// threads. The thesis leaves open what is decided here:
/// - Among equally near nodes, a voxel takes the node of a neighbour one step nearer: of the first
///   in the order -x, +x, -y, +y, -z, +z. Only such ties can differ from the thesis' queue, where
///   the order of the nodes decides.
/// - A node starts from all voxels of the domain that touch its lattice corner, at distance 0, even
///   if the corner alone connects them. A voxel that touches several nodes belongs to the first.
/// - Domains are connected through shared edges and corners of voxels. Voxels that paths over faces
///   do not reach are entered last, over an edge or a corner, and filled from there.
/// Only a component of the domain without any node keeps no_node. Linear time. Throws
/// std::invalid_argument if a node's corner lies outside the grid, MemoryLimitError if it would
/// take more than `byte_limit` bytes.
Grid3<std::uint32_t> node_map(const BitGrid3& domain, const SkeletonGraph& graph,
                              const ThreadPool& pool, std::uint64_t byte_limit);

}  // namespace lacuna
