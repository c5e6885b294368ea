#include "renderer/guides/importance_points.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace lacuna {

namespace {

/// Merges points of equal position, which leaves the mixture unchanged.
std::vector<ImportancePoint> merged(std::vector<ImportancePoint> points) {
  const auto before = [](const ImportancePoint& a, const ImportancePoint& b) {
    return std::tie(a.at.x, a.at.y, a.at.z) < std::tie(b.at.x, b.at.y, b.at.z);
  };
  std::stable_sort(points.begin(), points.end(), before);
  std::vector<ImportancePoint> all;
  for (const ImportancePoint& p : points) {
    if (!all.empty() && all.back().at == p.at) {
      all.back().weight += p.weight;
    } else {
      all.push_back(p);
    }
  }
  return all;
}

}  // namespace

ImportancePaths::ImportancePaths(const SkeletonGraph& graph, std::span<const double> importance,
                                 ImportanceAim aim)
    : graph_(graph), importance_(importance), aim_(aim), paths_(graph.nodes()) {
  const std::size_t n = graph.nodes();
  last_visible_.resize(n);
  steps_.resize(n);
  tightest_.resize(n);
  sum_.resize(n);
  size_.resize(n);
  weight_.resize(n);
  wanted_.resize(n);
}

void ImportancePaths::find_paths(std::uint32_t node) {
  settled_.clear();
  paths_.find(node, [&](std::uint32_t v, double d, const auto& reach) {
    settled_.push_back(v);
    for (const std::uint32_t next : graph_.of(v)) {
      const Imath::V3d edge(graph_.corners[next] - graph_.corners[v]);
      reach(next, d + edge.length(), v);
    }
  });
}

/// Marks importance nodes, and the nodes on shortest paths to them.
void ImportancePaths::mark_wanted() {
  for (const std::uint32_t v : settled_) wanted_[v] = importance_[v] > 0 ? 1 : 0;
  for (std::size_t i = settled_.size(); i-- > 1;) {
    if (wanted_[settled_[i]] != 0) wanted_[paths_.last[settled_[i]]] = 1;
  }
}

/// Appends `v` to the visible path from `node`.
void ImportancePaths::follow(std::uint32_t node, std::uint32_t v) {
  const Imath::V3d here(graph_.corners[v]);
  weight_[v] = 0;
  if (v == node) {
    sum_[v] = here;
    steps_[v] = 1;
    size_[v] = HUGE_VAL;  // the node lies inside its own ball
    tightest_[v] = v;
    return;
  }
  const std::uint32_t before = paths_.last[v];
  sum_[v] = sum_[before] + here;
  steps_[v] = steps_[before] + 1;
  const double size = double(graph_.radii[v]) / (here - Imath::V3d(graph_.corners[node])).length();
  const bool tighter = size < size_[before];
  size_[v] = tighter ? size : size_[before];
  tightest_[v] = tighter ? v : tightest_[before];
}

Imath::V3d ImportancePaths::aim_at(std::uint32_t v) const {
  switch (aim_) {
    case ImportanceAim::tightest:
      return Imath::V3d(graph_.corners[tightest_[v]]);
    case ImportanceAim::last:
      return Imath::V3d(graph_.corners[v]);
    case ImportanceAim::mean:
      break;
  }
  return sum_[v] / steps_[v];
}

std::vector<ImportancePoint> ImportancePaths::points(
    std::uint32_t node, const std::function<bool(std::uint32_t)>& sees) {
  find_paths(node);
  mark_wanted();
  const double least = std::max(0.5, double(graph_.radii[node]));
  for (const std::uint32_t v : settled_) {
    if (wanted_[v] == 0) continue;
    const std::uint32_t before = paths_.last[v];
    const bool visible = v == node || (last_visible_[before] == before && sees(v));
    last_visible_[v] = visible ? v : last_visible_[before];
    if (visible) follow(node, v);
    const double d = std::max(paths_.distance[v], least);
    if (importance_[v] > 0) weight_[last_visible_[v]] += importance_[v] / (d * d);
  }
  std::vector<ImportancePoint> points;
  for (const std::uint32_t v : settled_) {
    if (wanted_[v] == 0 || last_visible_[v] != v || !(weight_[v] > 0)) continue;
    points.push_back({aim_at(v), weight_[v]});
  }
  return merged(std::move(points));
}

}  // namespace lacuna
