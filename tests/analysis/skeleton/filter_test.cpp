#include <gtest/gtest.h>

#include "analysis/skeleton/filter.h"
#include "tests/analysis/skeleton/skeletons.h"

namespace lacuna::testing {
namespace {

using Imath::V3i;

void expect_sound_filtering(const SkeletonGraph& graph, const FilteredSkeleton& f,
                            const std::string& name) {
  EXPECT_EQ(fault(f.graph), "") << name;
  EXPECT_EQ(count_components(f.graph), count_components(graph)) << name;
  EXPECT_LE(count_loops(f.graph), count_loops(graph)) << name;
  ASSERT_EQ(f.parent.size(), graph.nodes()) << name;
  for (std::uint32_t i = 0; i < f.graph.nodes(); ++i) {
    ASSERT_EQ(f.parent[f.source[i]], i) << name;
    ASSERT_EQ(f.graph.corners[i], graph.corners[f.source[i]]) << name;
    ASSERT_EQ(f.graph.radii[i], graph.radii[f.source[i]]) << name;
    if (i > 0) {
      ASSERT_LT(f.source[i - 1], f.source[i]) << name;
    }
  }
  const auto component = components(graph), filtered_component = components(f.graph);
  std::vector<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t n = 0; n < graph.nodes(); ++n) {
    const std::uint32_t centre = f.source[f.parent[n]];
    ASSERT_TRUE(graph.in_ball(n, centre)) << name << " node " << n;
    ASSERT_GE(graph.radii[centre], graph.radii[n]) << name << " node " << n;
    ASSERT_EQ(component[centre], component[n]) << name << " node " << n;
    for (const std::uint32_t m : graph.of(n)) edges.push_back({f.parent[n], f.parent[m]});
  }
  SkeletonGraph contracted = f.graph;
  set_edges(contracted, edges);
  EXPECT_TRUE(same(contracted, f.graph)) << name;
}

/// Nodes of one parent hang together without leaving it.
void expect_connected_parts(const SkeletonGraph& graph, const FilteredSkeleton& f,
                            const std::string& name) {
  std::vector<std::array<std::uint32_t, 2>> inner;
  for (std::uint32_t n = 0; n < graph.nodes(); ++n)
    for (const std::uint32_t m : graph.of(n))
      if (f.parent[n] == f.parent[m]) inner.push_back({n, m});
  SkeletonGraph parts = graph;
  set_edges(parts, inner);
  EXPECT_EQ(count_components(parts), f.graph.nodes()) << name;
}

TEST(Filter, ContractsConnectedPartsWithinBalls) {
  for (const auto& [name, domain] : domains()) {
    const SkeletonGraph graph = space_of(domain).graph;
    const FilteredSkeleton f = filter_skeleton(graph);
    expect_sound_filtering(graph, f, name);
    expect_connected_parts(graph, f, name);
  }
}

/// Lines 1 to 8 of Alg. 4 as they stand, over all nodes for each node; accessible as filter.h says.
std::vector<std::uint32_t> literal_owners(const SkeletonGraph& graph) {
  std::vector<std::uint32_t> order(graph.nodes()), owner(graph.nodes(), no_node);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return graph.radii[a] != graph.radii[b] ? graph.radii[a] > graph.radii[b] : a < b;
  });
  for (const std::uint32_t i : order) {
    if (owner[i] != no_node) continue;
    owner[i] = i;
    for (bool more = true; more;) {
      more = false;
      for (std::uint32_t j = 0; j < graph.nodes(); ++j) {
        const auto near = graph.of(j);
        const bool accessible =
            std::any_of(near.begin(), near.end(), [&](std::uint32_t k) { return owner[k] == i; });
        if (owner[j] != no_node || !accessible || !graph.in_ball(j, i)) continue;
        owner[j] = i;
        more = true;
      }
    }
  }
  return owner;
}

TEST(Filter, IsTheAlgorithmOfTheThesis) {
  for (const auto& [name, domain] : domains()) {
    const SkeletonGraph graph = space_of(domain).graph;
    const FilteredSkeleton f = filter_skeleton(graph);
    const std::vector<std::uint32_t> owner = literal_owners(graph);
    for (std::uint32_t n = 0; n < graph.nodes(); ++n)
      ASSERT_EQ(f.source[f.parent[n]], owner[n]) << name << " node " << n;
  }
}

TEST(Filter, KeepsFewNodesWhereSpaceIsWide) {
  const SkeletonGraph graph = straight_line(100, 10);
  const FilteredSkeleton f = filter_skeleton(graph);
  expect_sound_filtering(graph, f, "line");
  // Equal radii go by index: 0 takes 1 to 10, 11 takes the next ten, and so on.
  ASSERT_EQ(f.graph.nodes(), 10u);
  for (std::uint32_t i = 0; i < 10; ++i) EXPECT_EQ(f.source[i], 11 * i);
  EXPECT_EQ(f.graph.edges(), 9u);
  EXPECT_EQ(filter_skeleton(straight_line(100, 0)).graph.nodes(), 100u);
}

TEST(Filter, TakesTheWidestFirst) {
  SkeletonGraph graph = straight_line(9, 1);
  graph.radii[6] = 3;
  const FilteredSkeleton f = filter_skeleton(graph);
  // 6 takes 3 to 8, then 0 takes 1.
  EXPECT_EQ(f.source, (std::vector<std::uint32_t>{0, 2, 6}));
  EXPECT_EQ(f.parent, (std::vector<std::uint32_t>{0, 0, 1, 2, 2, 2, 2, 2, 2}));
}

TEST(Filter, DoesNotReachOverWhatLiesOutsideTheBall) {
  // A hairpin: node 6 is near node 0, but the way to it is long.
  const SkeletonGraph graph =
      make_graph({{0, 0, 0}, {2, 0, 0}, {4, 0, 0}, {6, 0, 0}, {4, 1, 0}, {2, 1, 0}, {0, 1, 0}},
                 {3, 1, 1, 1, 1, 1, 1}, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}});
  const FilteredSkeleton f = filter_skeleton(graph);
  expect_sound_filtering(graph, f, "hairpin");
  EXPECT_EQ(f.parent[0], f.parent[1]);
  EXPECT_NE(f.parent[0], f.parent[6]);
}

TEST(Filter, TakesNothingOneNodeAndLongLines) {
  EXPECT_EQ(filter_skeleton(make_graph({}, {}, {})).graph.nodes(), 0u);
  const FilteredSkeleton one = filter_skeleton(make_graph({{5, 5, 5}}, {2}, {}));
  EXPECT_EQ(one.graph.nodes(), 1u);
  EXPECT_EQ(fault(one.graph), "");
  EXPECT_EQ(filter_skeleton(straight_line(100'000, 4)).graph.nodes(), 20'000u);
}

// Where all numbers are exact, a distance equal to the radius is not less: 0 takes 1 to 3.
TEST(Filter, WithoutAccessTakesWhatIsNearerThanTheRadius) {
  const FilteredSkeleton line = filter_without_access(straight_line(1000, 4), {});
  expect_sound_filtering(straight_line(1000, 4), line, "line");
  EXPECT_EQ(line.graph.nodes(), 250u);
  const SkeletonGraph apart = make_graph({{0, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {3, 1, 1}, {{1, 2}});
  EXPECT_EQ(filter_without_access(apart, {}).source, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(filter_without_access(apart, {}).graph.edges(), 1u);
  EXPECT_EQ(filter_skeleton(apart).source, (std::vector<std::uint32_t>{0, 1}));
}

TEST(Filter, MovesWithTheGrid) {
  for (const auto& [name, domain] : domains()) {
    const V3i shift(1, 2, 8);
    const FilteredSkeleton a = filter_skeleton(space_of(domain).graph),
                           b = filter_skeleton(moved_space(domain, shift).graph);
    EXPECT_TRUE(same(a.graph, b.graph, shift)) << name;
    EXPECT_EQ(a.parent, b.parent) << name;
  }
}

}  // namespace
}  // namespace lacuna::testing
