#include "analysis/skeleton/simplify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <tuple>

#include "analysis/skeleton/adjacency.h"
#include "analysis/skeleton/lines.h"
#include "analysis/skeleton/subgraph.h"

namespace lacuna {
namespace {

/// A part of a line: an extremum, nodes between, the other extremum.
using Part = std::span<const std::uint32_t>;

class Simplifier {
 public:
  explicit Simplifier(const SkeletonGraph& graph)
      : graph_(graph), kept_(topology_nodes(graph)), kind_(graph.nodes(), NodeKind::topology) {
    lines_ = skeleton_lines(graph, kept_);
    for (const SkeletonLine& line : lines_) split(line);
    keep_loops();
  }

  SimplifiedSkeleton result() const;

 private:
  void keep(std::uint32_t node, NodeKind kind) {
    kept_[node] = true;
    kind_[node] = kind;
  }
  void split(Part line);
  std::vector<Part> parts(Part line) const;
  std::vector<Part> all_parts() const;
  double curvature(std::uint32_t node, std::uint32_t a, std::uint32_t b) const;
  std::optional<std::size_t> most_curved(Part part) const;
  std::optional<std::size_t> uncovered(Part part) const;
  void keep_loops();

  const SkeletonGraph& graph_;
  std::vector<SkeletonLine> lines_;
  std::vector<bool> kept_;
  std::vector<NodeKind> kind_;
};

/// Eq. 156.
double Simplifier::curvature(std::uint32_t node, std::uint32_t a, std::uint32_t b) const {
  const Imath::V3d from(graph_.corners[a]), along = Imath::V3d(graph_.corners[b]) - from;
  const Imath::V3d off = Imath::V3d(graph_.corners[node]) - from;
  const double d = a == b ? off.length() : off.cross(along).length() / along.length();
  if (d == 0) return 0;
  const auto r = static_cast<double>(graph_.radii[node]);
  return r > 0 ? d / r : std::numeric_limits<double>::infinity();
}

std::optional<std::size_t> Simplifier::most_curved(Part part) const {
  const auto off_middle = [&](std::size_t i) {
    return std::abs(2 * static_cast<std::ptrdiff_t>(i) -
                    static_cast<std::ptrdiff_t>(part.size() - 1));
  };
  std::optional<std::size_t> best;
  double largest = 1;
  for (std::size_t i = 1; i + 1 < part.size(); ++i) {
    const double c = curvature(part[i], part.front(), part.back());
    if (c > largest || (best && c == largest && off_middle(i) < off_middle(*best))) {
      best = i;
      largest = c;
    }
  }
  return best;
}

/// The middle one of the nodes in neither extremum's ball.
std::optional<std::size_t> Simplifier::uncovered(Part part) const {
  std::vector<std::size_t> outside;
  for (std::size_t i = 1; i + 1 < part.size(); ++i)
    if (!graph_.in_ball(part[i], part.front()) && !graph_.in_ball(part[i], part.back()))
      outside.push_back(i);
  if (outside.empty()) return {};
  return outside[outside.size() / 2];
}

/// Splits the whole line by curvature, then the resulting parts by coverage.
void Simplifier::split(Part line) {
  for (const NodeKind kind : {NodeKind::curvature, NodeKind::coverage}) {
    std::vector<Part> todo = parts(line);
    while (!todo.empty()) {
      const Part part = todo.back();
      todo.pop_back();
      const auto at = kind == NodeKind::curvature ? most_curved(part) : uncovered(part);
      if (!at) continue;
      keep(part[*at], kind);
      todo.push_back(part.first(*at + 1));
      todo.push_back(part.subspan(*at));
    }
  }
}

/// Cuts a line at the nodes that are kept.
std::vector<Part> Simplifier::parts(Part line) const {
  std::vector<Part> parts;
  for (std::size_t from = 0, i = 1; i < line.size(); ++i)
    if (kept_[line[i]]) {
      parts.push_back(line.subspan(from, i + 1 - from));
      from = i;
    }
  return parts;
}

std::vector<Part> Simplifier::all_parts() const {
  std::vector<Part> all;
  for (const SkeletonLine& line : lines_) {
    const std::vector<Part> some = parts(line);
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// Keeps the middle nodes of parts that would otherwise become self-loops or double edges.
void Simplifier::keep_loops() {
  struct Bridge {
    std::uint32_t a, b;
    std::size_t length;
    std::uint32_t first;  // inner node, to tell parts of equal length apart
    Part part;
  };
  for (bool again = true; again;) {
    again = false;
    std::vector<Bridge> bridges;
    for (const Part p : all_parts()) {
      const auto [a, b] = std::minmax(p.front(), p.back());
      bridges.push_back({a, b, p.size(), std::min(p[1], p[p.size() - 2]), p});
    }
    std::sort(bridges.begin(), bridges.end(), [](const Bridge& p, const Bridge& q) {
      return std::tie(p.a, p.b, p.length, p.first) < std::tie(q.a, q.b, q.length, q.first);
    });
    for (std::size_t i = 0; i < bridges.size(); ++i) {
      const Bridge& p = bridges[i];
      const bool beside = i > 0 && bridges[i - 1].a == p.a && bridges[i - 1].b == p.b;
      if (p.a != p.b && !beside) continue;
      keep(p.part[p.length / 2], NodeKind::topology);
      again = true;
    }
  }
}

SimplifiedSkeleton Simplifier::result() const {
  SimplifiedSkeleton simple;
  simple.parent = take_nodes(graph_, kept_, simple.graph, simple.source);
  for (const std::uint32_t n : simple.source) simple.kinds.push_back(kind_[n]);
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const Part part : all_parts()) {
    const std::uint32_t a = simple.parent[part.front()], b = simple.parent[part.back()];
    edges.push_back({a, b});
    const std::size_t last = part.size() - 1;
    for (std::size_t i = 1; i < last; ++i)
      simple.parent[part[i]] = 2 * i < last ? a : 2 * i > last ? b : std::min(a, b);
  }
  set_edges(simple.graph, edges);
  return simple;
}

}  // namespace

SimplifiedSkeleton simplify_skeleton(const SkeletonGraph& graph) {
  return Simplifier(graph).result();
}

}  // namespace lacuna
