#include "analysis/skeleton/clusters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/skeleton/gates.h"
#include "tests/analysis/skeleton/skeletons.h"

namespace lacuna::testing {
namespace {

using Imath::V3i;

SimplifiedSkeleton as_simplified(const SkeletonGraph& graph) {
  SimplifiedSkeleton s;
  s.graph = graph;
  s.kinds.assign(graph.nodes(), NodeKind::coverage);
  return s;
}

void expect_sound_clusters(const SimplifiedSkeleton& s, double alpha, const std::string& name) {
  const VisibilityClusters c = visibility_clusters(s, alpha);
  ASSERT_EQ(c.of_node.size(), s.graph.nodes()) << name;
  // Every cluster is one connected part.
  std::vector<std::array<std::uint32_t, 2>> inner;
  std::vector<float> widest(c.count, -1);
  for (std::uint32_t n = 0; n < s.graph.nodes(); ++n) {
    ASSERT_LT(c.of_node[n], c.count) << name;
    float& w = widest[c.of_node[n]];
    w = std::max(w, s.graph.radii[n]);
    for (const std::uint32_t m : s.graph.of(n))
      if (c.of_node[n] == c.of_node[m]) inner.push_back({n, m});
  }
  SkeletonGraph parts = s.graph;
  set_edges(parts, inner);
  EXPECT_EQ(count_components(parts), c.count) << name;
  EXPECT_TRUE(std::is_sorted(widest.rbegin(), widest.rend())) << name;

  // A node that is much narrower than its cluster lies in the ball of another of its nodes.
  for (std::uint32_t n = 0; n < s.graph.nodes(); ++n) {
    const auto radius = static_cast<double>(s.graph.radii[n]);
    if (radius >= (1 - alpha) * static_cast<double>(widest[c.of_node[n]])) continue;
    bool held = false;
    for (std::uint32_t m = 0; m < s.graph.nodes() && !held; ++m)
      held = m != n && c.of_node[m] == c.of_node[n] && s.graph.in_ball(n, m);
    ASSERT_TRUE(held) << name << ", alpha " << alpha << ", node " << n;
  }

  // Gates separate clusters: they are the edges that are not inner, and no others.
  const VisibilityGates g = visibility_gates(s.graph, c);
  EXPECT_EQ(g.gates.size() + parts.edges(), s.graph.edges()) << name;
  std::vector<std::vector<std::uint32_t>> leaving(c.count);
  for (std::uint32_t i = 0; i < g.gates.size(); ++i) {
    const VisibilityGate& gate = g.gates[i];
    const auto [a, b] = gate.nodes;
    ASSERT_LT(a, b) << name;
    ASSERT_NE(gate.clusters[0], gate.clusters[1]) << name;
    ASSERT_EQ(gate.clusters[0], c.of_node[a]) << name;
    ASSERT_EQ(gate.clusters[1], c.of_node[b]) << name;
    ASSERT_EQ(gate.radius, std::min(s.graph.radii[a], s.graph.radii[b])) << name;
    const Imath::V3f from(s.graph.corners[a]), to(s.graph.corners[b]);
    ASSERT_EQ(gate.centre * 2.0f, from + to) << name;
    ASSERT_NEAR(gate.axis.length(), 1, 1e-6) << name;
    ASSERT_NEAR(gate.axis.dot(to - from), (to - from).length(), 1e-4) << name;
    for (const std::uint32_t k : gate.clusters) leaving[k].push_back(i);
    if (alpha == 1) {  // nothing else stops a cluster
      ASSERT_TRUE(s.kinds[a] == NodeKind::curvature || s.kinds[b] == NodeKind::curvature) << name;
    }
  }
  for (std::uint32_t k = 0; k < c.count; ++k)
    ASSERT_TRUE(std::equal(leaving[k].begin(), leaving[k].end(), g.of(k).begin(), g.of(k).end()))
        << name;
}

TEST(Clusters, AreConnectedAndGatesSeparateThem) {
  for (const auto& [name, domain] : domains())
    for (const SkeletonGraph& graph : {space_of(domain).graph, graph_by_voxels(domain)})
      for (const double alpha : {0.0, 0.2, 1.0})
        expect_sound_clusters(simplify_skeleton(graph), alpha, name);
  expect_sound_clusters(as_simplified(make_graph({}, {}, {})), 0.2, "nothing");
  expect_sound_clusters(as_simplified(make_graph({{1, 1, 1}}, {0}, {})), 0.2, "one node");
  expect_sound_clusters(as_simplified(straight_line(100'000, 1)), 0.2, "long line");
}

/// Nodes 10 apart, so that none lies in the ball of another.
SkeletonGraph apart(const std::vector<float>& radii) {
  std::vector<V3i> corners;
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t i = 0; i < radii.size(); ++i) {
    corners.emplace_back(static_cast<int>(10 * i), 0, 0);
    if (i > 0) edges.push_back({i - 1, i});
  }
  return make_graph(corners, radii, edges);
}

TEST(Clusters, JoinNodesOfSimilarRadius) {
  const SimplifiedSkeleton s = as_simplified(apart({5, 4, 3.9f, 4.5f, 3}));
  // 5 takes 4 (20 % less), not 3.9; then 4.5 takes 3.9; 3 is alone.
  EXPECT_EQ(visibility_clusters(s, 0.2).of_node, (std::vector<std::uint32_t>{0, 0, 1, 1, 2}));
  EXPECT_EQ(visibility_clusters(s, 0).count, 5u);
  EXPECT_EQ(visibility_clusters(s, 1).count, 1u);
}

TEST(Clusters, StopAtCurvatureNodes) {
  SimplifiedSkeleton s = as_simplified(apart({5, 5, 5, 5, 5}));
  s.kinds[2] = NodeKind::curvature;
  EXPECT_EQ(visibility_clusters(s, 0.2).of_node, (std::vector<std::uint32_t>{0, 0, 1, 1, 1}));
}

TEST(Clusters, HoldWhatLiesInTheirBallsAndGrowNoFurtherAtABend) {
  SimplifiedSkeleton s =
      as_simplified(make_graph({{0, 0, 0}, {6, 0, 0}, {6, 14, 0}}, {8, 8, 8}, {{0, 1}, {1, 2}}));
  s.kinds[1] = NodeKind::curvature;
  EXPECT_EQ(visibility_clusters(s, 0.2).of_node, (std::vector<std::uint32_t>{0, 0, 1}));
  s.kinds[1] = NodeKind::coverage;
  EXPECT_EQ(visibility_clusters(s, 0.2).count, 1u);
  // A small node in a large ball belongs to it, whatever its radius.
  s = as_simplified(make_graph({{0, 0, 0}, {6, 0, 0}, {20, 0, 0}}, {8, 1, 1}, {{0, 1}, {1, 2}}));
  EXPECT_EQ(visibility_clusters(s, 0.2).of_node, (std::vector<std::uint32_t>{0, 0, 1}));
}

TEST(Clusters, TellTwoRoomsFromTheDoorBetween) {
  const SimplifiedSkeleton s = simplify_skeleton(space_of(two_rooms_and_a_door()).graph);
  const VisibilityClusters c = visibility_clusters(s, 0.2);
  const auto cluster_at = [&](int x) {  // of the node nearest to the middle of the plane at x
    std::uint32_t best = 0;
    int least = std::numeric_limits<int>::max();
    for (std::uint32_t n = 0; n < s.graph.nodes(); ++n) {
      const V3i d = s.graph.corners[n] - V3i(x, 11, 11);
      if (d.dot(d) < least) least = d.dot(d), best = n;
    }
    return c.of_node[best];
  };
  EXPECT_NE(cluster_at(12), cluster_at(40));
  const VisibilityGates g = visibility_gates(s.graph, c);
  ASSERT_FALSE(g.gates.empty());
  for (const VisibilityGate& gate : g.gates) EXPECT_LE(gate.radius, 11);
}

TEST(Gates, OfAOneVoxelPassageAreOpenByTheRadiiOfVoxels) {
  // The passage lies at low corners, at high ones, and between.
  for (const int y : {1, 11, 20}) {
    BitGrid3 domain({52, 22, 22});
    add_box(domain, {1, 1, 1}, {24, 21, 21});
    add_box(domain, {24, y, 6}, {28, y + 1, 7});
    add_box(domain, {28, 1, 1}, {51, 21, 21});
    const auto radii = [](const SkeletonGraph& graph) {
      const SimplifiedSkeleton s = simplify_skeleton(graph);
      std::vector<float> all;
      for (const VisibilityGate& g : visibility_gates(s.graph, visibility_clusters(s, 0.2)).gates)
        all.push_back(g.radius);
      return all;
    };
    const std::vector<float> corner = radii(space_of(domain).graph);
    const std::vector<float> voxel = radii(graph_by_voxels(domain));
    ASSERT_FALSE(corner.empty());
    ASSERT_FALSE(voxel.empty());
    EXPECT_EQ(*std::min_element(corner.begin(), corner.end()), 0) << y;
    EXPECT_EQ(*std::min_element(voxel.begin(), voxel.end()), 1) << y;
  }
}

TEST(Clusters, RefuseAnAlphaThatIsNoShare) {
  for (const double alpha : {-0.1, 1.1, std::nan("")})
    EXPECT_THROW(visibility_clusters(as_simplified(apart({1})), alpha), std::invalid_argument);
}

}  // namespace
}  // namespace lacuna::testing
