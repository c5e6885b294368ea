#include <gtest/gtest.h>

#include <cstring>

#include "analysis/skeleton/ball_radius.h"
#include "analysis/skeleton/filter.h"
#include "analysis/skeleton/node_map.h"
#include "analysis/skeleton/sight.h"
#include "analysis/skeleton/visible_map.h"
#include "tests/analysis/skeleton/skeletons.h"

namespace lacuna::testing {
namespace {

using Imath::V3i;

/// Whether the line from the voxel's centre to the corner, which is left out, meets a closed cube
/// outside the domain: for all cubes in the box around the line, in whole numbers.
bool sees_by_definition(const BitGrid3& domain, V3i voxel, V3i corner) {
  const V3i d = 2 * corner - 2 * voxel - V3i(1);
  const std::int64_t whole = std::int64_t{d.x} * d.y * d.z;  // positions on the line in 1 / |whole|
  const std::int64_t end = std::abs(whole);
  V3i low, high, q;
  for (int a = 0; a < 3; ++a) {
    low[a] = std::min(voxel[a], corner[a] - 1) - 1;
    high[a] = std::max(voxel[a], corner[a]) + 1;
  }
  for (q.z = low.z; q.z <= high.z; ++q.z)
    for (q.y = low.y; q.y <= high.y; ++q.y)
      for (q.x = low.x; q.x <= high.x; ++q.x) {
        if (in_grid(q, domain.size()) && domain.get(q)) continue;
        std::int64_t from = 0, to = end;
        for (int a = 0; a < 3; ++a) {
          const std::int64_t scale = end / d[a];  // of either sign
          const std::int64_t enter = (2 * (q[a] - voxel[a]) - 1) * scale,
                             leave = (2 * (q[a] - voxel[a]) + 1) * scale;
          from = std::max(from, std::min(enter, leave));
          to = std::min(to, std::max(enter, leave));
        }
        if (from <= to && from < end) return false;
      }
  return true;
}

TEST(Sight, IsBlockedByEveryClosedCubeOnTheLine) {
  std::size_t seen = 0, unseen = 0;
  for (const auto& [name, domain] : domains()) {
    const auto l1 = l1_distance(domain, threads(), no_memory_limit);
    std::mt19937 random(7);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
    for (int i = 0; i < 3000; ++i) {
      const V3i n = domain.size(), v(below(n.x), below(n.y), below(n.z));
      const V3i c(below(n.x + 1), below(n.y + 1), below(n.z + 1));
      if (!domain.get(v)) continue;
      const bool expected = sees_by_definition(domain, v, c);
      ASSERT_EQ(sees(l1, v, c), expected) << name << ' ' << v << " to " << c;
      ASSERT_EQ(sees(l1, v, c, squared_ball_radius(l1, c)), expected) << name << ' ' << v << c;
      ++(expected ? seen : unseen);
    }
  }
  EXPECT_GT(seen, 2000u);
  EXPECT_GT(unseen, 2000u);
}

TEST(Sight, DoesNotPassBetweenVoxelsThatTouchAtAnEdge) {
  BitGrid3 domain = random_voxels({9, 9, 3}, 1, 0, 1);
  for (int i = 0; i < 9; ++i)
    for (int z = 0; z < 3; ++z) domain.reset({i, 8 - i, z});  // a wall of diagonal voxels
  const auto l1 = l1_distance(domain, threads(), no_memory_limit);
  EXPECT_FALSE(sees(l1, {1, 1, 1}, {8, 8, 2}));
  EXPECT_FALSE(sees(l1, {7, 7, 1}, {1, 1, 1}));
  EXPECT_TRUE(sees(l1, {1, 1, 1}, {4, 4, 2}));
}

TEST(VisibleMap, KeepsNodesInSightAndTakesTheNearestSeenOfThoseTried) {
  for (const auto& [name, domain] : domains())
    for (const bool filtered : {false, true}) {
      const Space space = space_of(domain);
      const SkeletonGraph graph = filtered ? filter_skeleton(space.graph).graph : space.graph;
      const auto before = node_map(domain, graph, threads(), no_memory_limit);
      auto after = node_map(domain, graph, threads(), no_memory_limit);
      const SightReport report = prefer_visible_nodes(after, graph, space.l1, threads());
      SightReport counted;
      for (std::size_t i = 0; i < before.count(); ++i) {
        if (before[i] == no_node) {
          ASSERT_EQ(after[i], no_node);
          continue;
        }
        const V3i v = before.voxel(i);
        const bool saw = sees_by_definition(domain, v, graph.corners[before[i]]);
        const bool does = sees_by_definition(domain, v, graph.corners[after[i]]);
        ++counted.mapped;
        counted.seen_before += saw;
        counted.seen_after += does;
        if (saw || !does) {
          ASSERT_EQ(after[i], before[i]) << name << v;
        }
        if (!does) {
          // No neighbour in the graph, which are always tried, is in sight.
          for (const std::uint32_t m : graph.of(before[i]))
            ASSERT_FALSE(sees_by_definition(domain, v, graph.corners[m])) << name << ' ' << v;
        }
      }
      EXPECT_EQ(report.mapped, counted.mapped) << name;
      EXPECT_EQ(report.seen_before, counted.seen_before) << name;
      EXPECT_EQ(report.seen_after, counted.seen_after) << name;
    }
}

TEST(VisibleMap, TriesTheNearestFirst) {
  BitGrid3 domain = random_voxels({12, 9, 9}, 1, 0, 1);
  for (int y = 0; y < 9; ++y) domain.reset({6, y, 4}), domain.reset({6, y, 5});
  const auto l1 = l1_distance(domain, threads(), no_memory_limit);
  // Node 0 is behind the bar; 1 and 2 are in sight, 2 is nearer, 3 nearer still but out of reach.
  const SkeletonGraph graph =
      make_graph({{10, 4, 5}, {1, 8, 8}, {4, 5, 5}, {2, 4, 5}}, {0, 0, 0, 0}, {{0, 1}, {0, 2}});
  Grid3<std::uint32_t> map(domain.size());
  for (std::size_t i = 0; i < map.count(); ++i) map[i] = no_node;
  const V3i v(2, 4, 4);
  map(v) = 0;
  const SightReport report = prefer_visible_nodes(map, graph, l1, threads());
  EXPECT_EQ(map(v), 2u);
  EXPECT_EQ(report.mapped, 1u);
  EXPECT_EQ(report.seen_before, 0u);
  EXPECT_EQ(report.seen_after, 1u);
}

TEST(VisibleMap, IsTheSameForAnyNumberOfThreads) {
  const Space space = space_of(random_voxels({60, 50, 40}, 0.001, 7, 3));
  const SkeletonGraph graph = filter_skeleton(space.graph).graph;
  auto a = node_map(space.domain, graph, threads(), no_memory_limit);
  auto b = node_map(space.domain, graph, threads(), no_memory_limit);
  const SightReport one = prefer_visible_nodes(a, graph, space.l1, ThreadPool(1));
  const SightReport four = prefer_visible_nodes(b, graph, space.l1, threads());
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.count() * sizeof(std::uint32_t)), 0);
  EXPECT_EQ(one.seen_after, four.seen_after);
  EXPECT_GT(one.seen_after, one.seen_before);
}

TEST(VisibleMap, DoesNotDependOnTheNodesRadii) {
  const BitGrid3 domain = random_voxels({40, 30, 30}, 0.001, 6, 5);
  const auto l1 = l1_distance(domain, threads(), no_memory_limit);
  const SkeletonGraph graph = space_of(domain).graph;
  SkeletonGraph wide = graph_by_voxels(domain);
  for (float& r : wide.radii) r += 3;
  auto a = node_map(domain, graph, threads(), no_memory_limit);
  auto b = node_map(domain, graph, threads(), no_memory_limit);
  const SightReport report = prefer_visible_nodes(a, graph, l1, threads());
  EXPECT_EQ(prefer_visible_nodes(b, wide, l1, threads()).seen_after, report.seen_after);
  EXPECT_EQ(std::memcmp(a.data(), b.data(), a.count() * sizeof(std::uint32_t)), 0);
  EXPECT_LT(report.seen_before, report.mapped) << "all voxels see their node";
}

TEST(VisibleMap, RefusesGridsOfDifferentSizes) {
  Grid3<std::uint32_t> map(V3i(2, 2, 2));
  EXPECT_THROW(prefer_visible_nodes(map, make_graph({}, {}, {}), Grid3<std::uint16_t>(V3i(2, 2, 3)),
                                    threads()),
               std::invalid_argument);
}

}  // namespace
}  // namespace lacuna::testing
