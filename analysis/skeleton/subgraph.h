#pragma once

#include <vector>

#include "analysis/skeleton/graph.h"

namespace lacuna {

/// Copies the `kept` nodes of `graph` to `taken`, in their order and without edges, and sets
/// `source` to their indices in `graph`. Returns for each node of `graph` its index in `taken`, or
/// no_node.
inline std::vector<std::uint32_t> take_nodes(const SkeletonGraph& graph,
                                             const std::vector<bool>& kept, SkeletonGraph& taken,
                                             std::vector<std::uint32_t>& source) {
  std::vector<std::uint32_t> number(graph.nodes(), no_node);
  for (std::uint32_t n = 0; n < graph.nodes(); ++n) {
    if (!kept[n]) continue;
    number[n] = static_cast<std::uint32_t>(taken.nodes());
    taken.corners.push_back(graph.corners[n]);
    taken.radii.push_back(graph.radii[n]);
    source.push_back(n);
  }
  return number;
}

}  // namespace lacuna
