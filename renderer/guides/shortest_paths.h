#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

namespace lacuna {

/// The shortest paths from one node of a graph to all others.
struct ShortestPaths {
  std::vector<double> distance;  ///< of each node; infinite if no path leads to it
  std::vector<std::uint32_t>
      last;  ///< the last edge of its path, as passed to reach(); the source: 0

  explicit ShortestPaths(std::size_t nodes) : distance(nodes), last(nodes) {}

  /// Dijkstra's algorithm from `source`. Calls settle(node, distance, reach) for every reachable
  /// node in order of distance, then of index; it must call reach(next, distance of next by way of
  /// node, edge) for every neighbour. Lengths are >= 0.
  template <class Settle>
  void find(std::uint32_t source, const Settle& settle) {
    using Reached = std::pair<double, std::uint32_t>;
    std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
    std::fill(distance.begin(), distance.end(), HUGE_VAL);
    const auto reach = [&](std::uint32_t node, double d, std::uint32_t edge) {
      if (d >= distance[node]) return;
      distance[node] = d;
      last[node] = edge;
      open.push({d, node});
    };
    reach(source, 0, 0);
    while (!open.empty()) {
      const auto [d, node] = open.top();
      open.pop();
      if (d > distance[node]) continue;  // a shorter path was found later
      settle(node, d, reach);
    }
  }
};

}  // namespace lacuna
