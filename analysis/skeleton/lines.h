#pragma once

#include <cstdint>
#include <vector>

#include "analysis/skeleton/graph.h"

namespace lacuna {

/// A skeleton line (Noel 2015, 7.2.1): an extremum, the nodes along the line, the other extremum;
/// each is a neighbour of the next. The extrema may be the same node.
using SkeletonLine = std::vector<std::uint32_t>;

/// Marks the ends of lines: the nodes of degree other than two, and in a ring without such a node
/// the node of largest radius (the first among equals).
std::vector<bool> topology_nodes(const SkeletonGraph& graph);

/// All lines between the nodes marked as ends, each once. Every ring of the graph must contain an
/// end, and all other nodes must have two neighbours.
std::vector<SkeletonLine> skeleton_lines(const SkeletonGraph& graph, const std::vector<bool>& ends);

}  // namespace lacuna
