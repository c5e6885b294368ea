#include "analysis/skeleton/filter.h"

#include <algorithm>
#include <cmath>

#include "analysis/skeleton/adjacency.h"
#include "analysis/skeleton/by_radius.h"
#include "analysis/skeleton/subgraph.h"

namespace lacuna {
namespace {

/// The node that each node belongs to, possibly itself (lines 1-8 of Alg. 4).
std::vector<std::uint32_t> claim(const SkeletonGraph& graph) {
  std::vector<std::uint32_t> owner(graph.nodes(), no_node), found;
  for (const std::uint32_t centre : by_falling_radius(graph)) {
    if (owner[centre] != no_node) continue;
    owner[centre] = centre;
    found.assign(1, centre);
    while (!found.empty()) {
      const std::uint32_t n = found.back();
      found.pop_back();
      for (const std::uint32_t m : graph.of(n)) {
        if (owner[m] != no_node || !graph.in_ball(m, centre)) continue;
        owner[m] = centre;
        found.push_back(m);
      }
    }
  }
  return owner;
}

/// The same, accessible or not.
std::vector<std::uint32_t> claim_all(const SkeletonGraph& graph, const GridTransform& transform) {
  std::vector<std::uint32_t> owner(graph.nodes(), no_node);
  std::vector<Imath::V3f> positions;
  const auto unit = static_cast<float>(transform.voxel_size);
  for (const Imath::V3i& c : graph.corners) {
    positions.push_back(Imath::V3f(c) * unit + Imath::V3f(transform.origin));
  }
  std::vector<std::uint32_t> order = by_falling_radius(graph);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return graph.radii[a] == graph.radii[b] ? graph.degree(a) > graph.degree(b)
                                            : graph.radii[a] > graph.radii[b];
  });
  for (const std::uint32_t centre : order) {
    if (owner[centre] != no_node) continue;
    const float radius = graph.radii[centre] * unit;
    for (std::uint32_t n = 0; n < graph.nodes(); ++n) {
      const Imath::V3f d = positions[n] - positions[centre];
      if (owner[n] == no_node && std::sqrt(d.dot(d)) < radius) owner[n] = centre;
    }
    owner[centre] = centre;
  }
  return owner;
}

FilteredSkeleton contract(const SkeletonGraph& graph, const std::vector<std::uint32_t>& owner) {
  FilteredSkeleton filtered;
  std::vector<bool> kept(graph.nodes());
  for (std::uint32_t n = 0; n < graph.nodes(); ++n) kept[n] = owner[n] == n;
  const std::vector<std::uint32_t> number =
      take_nodes(graph, kept, filtered.graph, filtered.source);
  filtered.parent.resize(graph.nodes());
  for (std::uint32_t n = 0; n < graph.nodes(); ++n) filtered.parent[n] = number[owner[n]];

  // Lines 10-18: edges between parts become edges between the nodes that represent them.
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t n = 0; n < graph.nodes(); ++n)
    for (const std::uint32_t m : graph.of(n))
      if (n < m && filtered.parent[n] != filtered.parent[m])
        edges.push_back({filtered.parent[n], filtered.parent[m]});
  set_edges(filtered.graph, edges);
  return filtered;
}

}  // namespace

FilteredSkeleton filter_skeleton(const SkeletonGraph& graph) {
  return contract(graph, claim(graph));
}

FilteredSkeleton filter_without_access(const SkeletonGraph& graph, const GridTransform& transform) {
  return contract(graph, claim_all(graph, transform));
}

}  // namespace lacuna
