#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/skeleton/graph.h"

namespace lacuna {

/// Sets the edges of a graph, whose nodes are set already, in linear time. An edge may be listed
/// several times, in either direction; edges from a node to itself are ignored.
void set_edges(SkeletonGraph& graph, const std::vector<std::array<std::uint32_t, 2>>& edges);

}  // namespace lacuna
