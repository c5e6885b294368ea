#include "analysis/skeleton/adjacency.h"

#include <algorithm>
#include <numeric>

namespace lacuna {

void set_edges(SkeletonGraph& graph, const std::vector<std::array<std::uint32_t, 2>>& edges) {
  const std::size_t nodes = graph.nodes();
  std::vector<std::uint32_t> end(nodes + 1, 0);
  for (const auto& [a, b] : edges)
    if (a != b) ++end[a + 1], ++end[b + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<std::uint32_t> all(end[nodes]);
  {
    std::vector<std::uint32_t> next(end.begin(), end.end());
    for (const auto& [a, b] : edges)
      if (a != b) all[next[a]++] = b, all[next[b]++] = a;
  }
  graph.first.assign(nodes + 1, 0);
  graph.neighbours.clear();
  graph.neighbours.reserve(all.size());
  for (std::size_t n = 0; n < nodes; ++n) {
    const auto from = all.begin() + end[n], to = all.begin() + end[n + 1];
    std::sort(from, to);
    graph.neighbours.insert(graph.neighbours.end(), from, std::unique(from, to));
    graph.first[n + 1] = static_cast<std::uint32_t>(graph.neighbours.size());
  }
}

}  // namespace lacuna
