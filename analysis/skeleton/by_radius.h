#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "analysis/skeleton/graph.h"

namespace lacuna {

/// The nodes by descending radius, then by index.
inline std::vector<std::uint32_t> by_falling_radius(const SkeletonGraph& graph) {
  std::vector<std::uint32_t> order(graph.nodes());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return graph.radii[a] > graph.radii[b];
  });
  return order;
}

}  // namespace lacuna
