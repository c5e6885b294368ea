#include "analysis/skeleton/gates.h"

#include <algorithm>
#include <numeric>

namespace lacuna {
namespace {

VisibilityGate gate(const SkeletonGraph& graph, const VisibilityClusters& clusters, std::uint32_t a,
                    std::uint32_t b) {
  const Imath::V3f from(graph.corners[a]), to(graph.corners[b]);
  return {.centre = (from + to) / 2,
          .axis = (to - from).normalized(),
          .radius = std::min(graph.radii[a], graph.radii[b]),
          .clusters = {clusters.of_node[a], clusters.of_node[b]},
          .nodes = {a, b}};
}

}  // namespace

VisibilityGates visibility_gates(const SkeletonGraph& simplified,
                                 const VisibilityClusters& clusters) {
  VisibilityGates result;
  for (std::uint32_t a = 0; a < simplified.nodes(); ++a)
    for (const std::uint32_t b : simplified.of(a))
      if (a < b && clusters.of_node[a] != clusters.of_node[b])
        result.gates.push_back(gate(simplified, clusters, a, b));

  result.first.assign(clusters.count + 1, 0);
  for (const VisibilityGate& g : result.gates)
    for (const std::uint32_t c : g.clusters) ++result.first[c + 1];
  std::partial_sum(result.first.begin(), result.first.end(), result.first.begin());
  result.by_cluster.resize(result.first.back());
  std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
  for (std::uint32_t i = 0; i < result.gates.size(); ++i)
    for (const std::uint32_t c : result.gates[i].clusters) result.by_cluster[next[c]++] = i;
  return result;
}

}  // namespace lacuna
