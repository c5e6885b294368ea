#include "analysis/skeleton/lines.h"

namespace lacuna {
namespace {

/// The neighbour of a node of degree two that is not `from`.
std::uint32_t onward(const SkeletonGraph& graph, std::uint32_t node, std::uint32_t from) {
  const auto neighbours = graph.of(node);
  return neighbours[0] == from ? neighbours[1] : neighbours[0];
}

}  // namespace

std::vector<bool> topology_nodes(const SkeletonGraph& graph) {
  std::vector<bool> ends(graph.nodes()), reached(graph.nodes());
  for (std::uint32_t n = 0; n < graph.nodes(); ++n) ends[n] = graph.degree(n) != 2;
  for (std::uint32_t end = 0; end < graph.nodes(); ++end) {
    if (graph.degree(end) == 2) continue;
    for (std::uint32_t n : graph.of(end))
      for (std::uint32_t from = end; !ends[n] && !reached[n];) {
        reached[n] = true;
        const std::uint32_t next = onward(graph, n, from);
        from = n;
        n = next;
      }
  }
  for (std::uint32_t start = 0; start < graph.nodes(); ++start) {
    if (ends[start] || reached[start]) continue;  // the remaining nodes lie on rings
    std::uint32_t widest = start, from = graph.of(start)[0];
    for (std::uint32_t n = start; !reached[n];) {
      reached[n] = true;
      if (graph.radii[n] > graph.radii[widest] ||
          (graph.radii[n] == graph.radii[widest] && n < widest))
        widest = n;
      const std::uint32_t next = onward(graph, n, from);
      from = n;
      n = next;
    }
    ends[widest] = true;
  }
  return ends;
}

std::vector<SkeletonLine> skeleton_lines(const SkeletonGraph& graph,
                                         const std::vector<bool>& ends) {
  std::vector<SkeletonLine> lines;
  std::vector<bool> on_line(graph.nodes());
  for (std::uint32_t end = 0; end < graph.nodes(); ++end) {
    if (!ends[end]) continue;
    for (std::uint32_t n : graph.of(end)) {
      if (ends[n] ? n < end : on_line[n]) continue;
      SkeletonLine line{end};
      for (std::uint32_t from = end; !ends[n];) {
        on_line[n] = true;
        line.push_back(n);
        const std::uint32_t next = onward(graph, n, from);
        from = n;
        n = next;
      }
      line.push_back(n);
      lines.push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace lacuna
