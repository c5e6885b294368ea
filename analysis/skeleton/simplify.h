#pragma once

#include <cstdint>
#include <vector>

#include "analysis/skeleton/graph.h"

namespace lacuna {

/// Why a node of the skeleton was kept (Noel 2015, 7.2.1).
enum class NodeKind : std::uint8_t {
  topology,   ///< degree other than two, or without it a loop would be lost
  curvature,  ///< lies further from the straight line between its extrema than its radius
  coverage,   ///< lies in the ball of neither of its extrema
};

/// The simplified skeleton: the nodes that define the shape, connected along the lines between
/// them.
struct SimplifiedSkeleton {
  SkeletonGraph graph;
  std::vector<NodeKind> kinds;        ///< of each node
  std::vector<std::uint32_t> source;  ///< original node of each node, ascending
  std::vector<std::uint32_t> parent;  ///< s(n): the nearest extremum of each original node
};

/// Noel 2015, 7.2.1. It has as many components and as many independent loops as `graph`, and every
/// node of `graph` lies in the ball of one of the two extrema of its line. The thesis leaves open
/// what is decided here:
/// - A line is split at its node of largest curvature (eq. 156) while that is above 1; among equals
///   at the one nearest to the line's middle. The curvature of a node of radius 0 off the straight
///   line is infinite. Where both extrema are one node, the distance is to this node.
/// - Then it is split at the middle one of the nodes that no extremum covers, until none is left.
/// - A ring without any node of degree other than two starts at its node of largest radius.
/// - Of a line that would begin and end at one node, or be parallel to another between the same two
///   extrema, the middle node is kept as well, as a topology node: a graph without double edges
///   would lose the loop.
/// - s(n) is nearest in edges along the line; between equals the one of lower index.
SimplifiedSkeleton simplify_skeleton(const SkeletonGraph& graph);

}  // namespace lacuna
