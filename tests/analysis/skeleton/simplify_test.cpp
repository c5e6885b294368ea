#include "analysis/skeleton/simplify.h"

#include <gtest/gtest.h>

#include <set>

#include "analysis/skeleton/lines.h"
#include "tests/analysis/skeleton/skeletons.h"

namespace lacuna::testing {
namespace {

using Imath::V3i;

/// A square ring of lattice nodes with sides of `side` edges, all of one radius.
SkeletonGraph square_ring(int side, float radius) {
  std::vector<V3i> corners;
  std::vector<std::array<std::uint32_t, 2>> edges;
  const std::array<V3i, 4> along{V3i(1, 0, 0), V3i(0, 1, 0), V3i(-1, 0, 0), V3i(0, -1, 0)};
  V3i at(0);
  for (const V3i& d : along)
    for (int i = 0; i < side; ++i, at += d) corners.push_back(at);
  const auto n = static_cast<std::uint32_t>(corners.size());
  for (std::uint32_t i = 0; i < n; ++i) edges.push_back({i, (i + 1) % n});
  return make_graph(corners, std::vector<float>(n, radius), edges);
}

/// From (0, 0) along x to a corner, then along y.
SkeletonGraph bent_line(int first, int second, float radius) {
  std::vector<V3i> corners;
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (int i = 0; i <= first; ++i) corners.emplace_back(i, 0, 0);
  for (int i = 1; i <= second; ++i) corners.emplace_back(first, i, 0);
  for (std::uint32_t i = 1; i < corners.size(); ++i) edges.push_back({i - 1, i});
  return make_graph(corners, std::vector<float>(corners.size(), radius), edges);
}

void expect_sound_simplification(const SkeletonGraph& graph, const std::string& name) {
  const SimplifiedSkeleton s = simplify_skeleton(graph);
  EXPECT_EQ(fault(s.graph), "") << name;
  EXPECT_EQ(count_components(s.graph), count_components(graph)) << name;
  EXPECT_EQ(count_loops(s.graph), count_loops(graph)) << name;
  ASSERT_EQ(s.kinds.size(), s.graph.nodes()) << name;
  ASSERT_EQ(s.parent.size(), graph.nodes()) << name;
  std::vector<bool> kept(graph.nodes());
  for (std::uint32_t i = 0; i < s.graph.nodes(); ++i) {
    ASSERT_EQ(s.parent[s.source[i]], i) << name;
    kept[s.source[i]] = true;
    if (graph.degree(s.source[i]) != 2) {
      ASSERT_EQ(s.kinds[i], NodeKind::topology) << name;
    }
  }
  // The lines between kept nodes are the edges; nodes on them are covered, not curved, and belong
  // to the nearer extremum.
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (const SkeletonLine& line : skeleton_lines(graph, kept)) {
    const std::uint32_t a = line.front(), b = line.back();
    ASSERT_NE(a, b) << name;
    edges.push_back({s.parent[a], s.parent[b]});
    for (std::size_t i = 1; i + 1 < line.size(); ++i) {
      const std::size_t to_b = line.size() - 1 - i;
      const std::uint32_t near = i < to_b ? a : i > to_b ? b : std::min(a, b);
      ASSERT_EQ(s.parent[line[i]], s.parent[near]) << name;
      ASSERT_TRUE(graph.in_ball(line[i], a) || graph.in_ball(line[i], b)) << name;
    }
  }
  EXPECT_EQ(s.graph.edges(), edges.size()) << name;
  SkeletonGraph expected = s.graph;
  set_edges(expected, edges);
  EXPECT_TRUE(same(expected, s.graph)) << name;
}

TEST(Simplify, KeepsTopologyAndCoversEveryLine) {
  for (const auto& [name, domain] : domains())
    expect_sound_simplification(space_of(domain).graph, name);
  expect_sound_simplification(square_ring(1, 5), "smallest ring");
  expect_sound_simplification(square_ring(20, 4), "ring");
  expect_sound_simplification(bent_line(30, 20, 6), "bend");
  expect_sound_simplification(straight_line(50, 0), "line that touches the scene");
}

TEST(Simplify, SplitsABendAtItsCorner) {
  const SkeletonGraph graph = bent_line(12, 12, 8);
  const SimplifiedSkeleton s = simplify_skeleton(graph);
  EXPECT_EQ(s.source, (std::vector<std::uint32_t>{0, 12, 24}));
  EXPECT_EQ(s.kinds, (std::vector{NodeKind::topology, NodeKind::curvature, NodeKind::topology}));
  // The corner's distance to the straight line is 12 / sqrt(2) = 8.49: within a radius of 9 there
  // is no curvature, only coverage.
  const SimplifiedSkeleton wide = simplify_skeleton(bent_line(12, 12, 9));
  for (const NodeKind kind : wide.kinds) EXPECT_NE(kind, NodeKind::curvature);
}

TEST(Simplify, PutsCoverageNodesIntoTheMiddleOfWhatIsBare) {
  // Extrema 0 and 40 cover 10 nodes each: 11 to 29 are bare, 20 is their middle and covers the
  // rest.
  const SimplifiedSkeleton s = simplify_skeleton(straight_line(41, 10));
  EXPECT_EQ(s.source, (std::vector<std::uint32_t>{0, 20, 40}));
  EXPECT_EQ(s.kinds[1], NodeKind::coverage);
  EXPECT_EQ(s.parent[9], 0u);
  EXPECT_EQ(s.parent[10], 0u);  // halfway: the lower
  EXPECT_EQ(s.parent[11], 1u);
}

TEST(Simplify, KeepsARingWhoseBallsWouldSwallowIt) {
  SkeletonGraph graph = square_ring(2, 100);
  graph.radii[5] = 101;
  const SimplifiedSkeleton s = simplify_skeleton(graph);
  EXPECT_EQ(s.graph.nodes(), 3u);
  EXPECT_EQ(s.graph.edges(), 3u);
  EXPECT_TRUE(std::find(s.source.begin(), s.source.end(), 5u) != s.source.end());
  for (const NodeKind kind : s.kinds) EXPECT_EQ(kind, NodeKind::topology);
}

TEST(Simplify, KeepsLinesSideBySide) {
  // Two nodes of degree three, joined by an edge and two longer lines, in balls that hold all.
  const SkeletonGraph graph = make_graph(
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 0, 1}, {1, 0, 1}}, std::vector<float>(6, 50),
      {{0, 1}, {0, 2}, {2, 3}, {3, 1}, {0, 4}, {4, 5}, {5, 1}});
  ASSERT_EQ(count_loops(graph), 2u);
  expect_sound_simplification(graph, "theta");
  EXPECT_EQ(simplify_skeleton(graph).graph.nodes(), 4u);
}

TEST(Simplify, TakesNothingOneNodeAndLongLines) {
  EXPECT_EQ(simplify_skeleton(make_graph({}, {}, {})).graph.nodes(), 0u);
  expect_sound_simplification(make_graph({{3, 2, 1}}, {0}, {}), "one node");
  expect_sound_simplification(make_graph({{3, 2, 1}, {4, 2, 1}, {9, 9, 9}}, {0, 1, 2}, {{0, 1}}),
                              "two parts");
  expect_sound_simplification(straight_line(100'000, 3), "long line");
}

TEST(Simplify, MovesWithTheGrid) {
  const V3i shift(1, 2, 8);
  for (const auto& [name, domain] : domains()) {
    const SimplifiedSkeleton a = simplify_skeleton(space_of(domain).graph),
                             b = simplify_skeleton(moved_space(domain, shift).graph);
    EXPECT_TRUE(same(a.graph, b.graph, shift)) << name;
    EXPECT_EQ(a.parent, b.parent) << name;
  }
}

}  // namespace
}  // namespace lacuna::testing
