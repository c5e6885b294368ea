// Importance points against what the thesis says of every importance node by itself.

#include "renderer/guides/importance_points.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <tuple>

#include "analysis/skeleton/adjacency.h"

namespace lacuna {
namespace {

using Imath::V3d;
using Imath::V3i;

/// A graph of `n` nodes at random corners, a tree and a few more edges; the last node is alone.
SkeletonGraph random_graph(std::uint32_t n, std::mt19937& random) {
  SkeletonGraph graph;
  std::uniform_int_distribution<int> place(0, 1000);
  for (std::uint32_t i = 0; i < n; ++i) {
    graph.corners.emplace_back(place(random), place(random), place(random));
    graph.radii.push_back(static_cast<float>(place(random)) / 20);
  }
  const auto below = [&](std::uint32_t m) { return static_cast<std::uint32_t>(random() % m); };
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t i = 1; i + 1 < n; ++i) edges.push_back({i, i - 1 - below(std::min(i, 3U))});
  for (int k = 0; k < 4; ++k) edges.push_back({below(n - 1), below(n - 1)});
  set_edges(graph, edges);
  return graph;
}

/// Distances and nodes before, from `from`, by relaxing every edge n times.
struct Paths {
  std::vector<double> distance;
  std::vector<std::uint32_t> before;
  Paths(const SkeletonGraph& g, std::uint32_t from)
      : distance(g.nodes(), HUGE_VAL), before(g.nodes(), from) {
    distance[from] = 0;
    for (std::size_t round = 0; round < g.nodes(); ++round) {
      for (std::uint32_t v = 0; v < g.nodes(); ++v) {
        for (const std::uint32_t u : g.of(v)) {
          const double there = distance[v] + V3d(g.corners[u] - g.corners[v]).length();
          if (there < distance[u]) distance[u] = there, before[u] = v;
        }
      }
    }
  }
};

bool sees(std::uint32_t a, std::uint32_t b) { return (a * 7 + b * 13) % 4 != 0; }

/// Eq. 162 and 164, importance node by importance node.
std::map<std::tuple<double, double, double>, double> by_definition(
    const SkeletonGraph& g, const std::vector<double>& importance, std::uint32_t node,
    ImportanceAim aim) {
  std::map<std::tuple<double, double, double>, double> lobes;
  const Paths paths(g, node);
  for (std::uint32_t i = 0; i < g.nodes(); ++i) {
    if (!(importance[i] > 0) || paths.distance[i] == HUGE_VAL) continue;
    std::vector<std::uint32_t> path{i};
    while (path.back() != node) path.push_back(paths.before[path.back()]);
    std::reverse(path.begin(), path.end());
    std::size_t seen = 1;
    while (seen < path.size() && sees(node, path[seen])) ++seen;
    V3d at(0.0);
    for (std::size_t k = 0; k < seen; ++k) at += V3d(g.corners[path[k]]);
    at /= static_cast<double>(seen);
    if (aim == ImportanceAim::last) at = V3d(g.corners[path[seen - 1]]);
    if (aim == ImportanceAim::tightest) {
      at = V3d(g.corners[node]);
      double smallest = HUGE_VAL;
      for (std::size_t k = 1; k < seen; ++k) {
        const V3d there(g.corners[path[k]]);
        const double size = double(g.radii[path[k]]) / (there - V3d(g.corners[node])).length();
        if (size < smallest) smallest = size, at = there;
      }
    }
    const double d = std::max({paths.distance[i], 0.5, double(g.radii[node])});
    lobes[{at.x, at.y, at.z}] += importance[i] / (d * d);
  }
  return lobes;
}

TEST(ImportancePoints, FoldWhatSharesAPoint) {
  std::mt19937 random(3);
  for (int round = 0; round < 30; ++round) {
    const SkeletonGraph g = random_graph(40, random);
    std::vector<double> importance(g.nodes(), 0.0);
    for (double& f : importance) f = random() % 3 == 0 ? double(random() % 1000) : 0.0;
    importance.back() = 5;  // in a component of its own
    for (const auto aim : {ImportanceAim::mean, ImportanceAim::last, ImportanceAim::tightest}) {
      ImportancePaths paths(g, importance, aim);
      for (std::uint32_t node = 0; node < g.nodes(); ++node) {
        const auto expected = by_definition(g, importance, node, aim);
        const auto found = paths.points(node, [&](std::uint32_t b) { return sees(node, b); });
        ASSERT_EQ(found.size(), expected.size());
        for (const ImportancePoint& p : found) {
          const auto it = expected.find({p.at.x, p.at.y, p.at.z});
          ASSERT_NE(it, expected.end());
          EXPECT_NEAR(p.weight, it->second, 1e-9 * it->second);
        }
      }
    }
  }
}

TEST(ImportancePoints, NoneWhereNothingIsImportant) {
  std::mt19937 random(4);
  const SkeletonGraph g = random_graph(10, random);
  std::vector<double> importance(g.nodes(), 0.0);
  const auto all = [](std::uint32_t) { return true; };
  EXPECT_TRUE(ImportancePaths(g, importance, ImportanceAim::last).points(0, all).empty());
  importance.back() = 1;  // out of reach
  ImportancePaths paths(g, importance, ImportanceAim::last);
  EXPECT_TRUE(paths.points(0, all).empty());
  const auto own = paths.points(9, all);
  ASSERT_EQ(own.size(), 1U);
  EXPECT_EQ(own[0].at, V3d(g.corners[9]));
}

}  // namespace
}  // namespace lacuna
