#include <gtest/gtest.h>

#include <set>

#include "analysis/skeleton/ball_radius.h"
#include "tests/analysis/skeleton/skeletons.h"

namespace lacuna::testing {
namespace {

using Imath::V3i;

/// The least squared distance from a corner to a closed cube outside the domain, by all cubes.
std::int64_t radius2_by_definition(const BitGrid3& domain, V3i corner) {
  std::int64_t least = std::numeric_limits<std::int64_t>::max();
  V3i q;
  for (q.z = -1; q.z <= domain.size().z; ++q.z)
    for (q.y = -1; q.y <= domain.size().y; ++q.y)
      for (q.x = -1; q.x <= domain.size().x; ++q.x) {
        if (in_grid(q, domain.size()) && domain.get(q)) continue;
        std::int64_t d2 = 0;
        for (int a = 0; a < 3; ++a) {
          const int d = std::max({q[a] - corner[a], corner[a] - q[a] - 1, 0});
          d2 += d * d;
        }
        least = std::min(least, d2);
      }
  return least;
}

TEST(BallRadius, IsTheDistanceToTheNearestClosedCube) {
  for (const auto& [name, domain] : domains()) {
    const auto l1 = l1_distance(domain, threads(), no_memory_limit);
    V3i c;
    for (c.z = 0; c.z <= domain.size().z; c.z += 3)
      for (c.y = 0; c.y <= domain.size().y; c.y += 2)
        for (c.x = 0; c.x <= domain.size().x; c.x += 3)
          ASSERT_EQ(squared_ball_radius(l1, c), radius2_by_definition(domain, c))
              << name << ' ' << c;
  }
}

/// Of the domain's voxels at a corner the largest squared distance, between centres, to the nearest
/// voxel outside the domain.
std::int64_t voxel_radius2_by_definition(const BitGrid3& domain, V3i corner) {
  std::int64_t most = 0;
  V3i v, q;
  for (v.z = corner.z - 1; v.z <= corner.z; ++v.z)
    for (v.y = corner.y - 1; v.y <= corner.y; ++v.y)
      for (v.x = corner.x - 1; v.x <= corner.x; ++v.x) {
        if (!in_grid(v, domain.size()) || !domain.get(v)) continue;
        std::int64_t least = std::numeric_limits<std::int64_t>::max();
        for (q.z = -1; q.z <= domain.size().z; ++q.z)
          for (q.y = -1; q.y <= domain.size().y; ++q.y)
            for (q.x = -1; q.x <= domain.size().x; ++q.x)
              if (!in_grid(q, domain.size()) || !domain.get(q))
                least = std::min(least, std::int64_t{(v - q).dot(v - q)});
        most = std::max(most, least);
      }
  return most;
}

TEST(VoxelRadius, IsTheLargestDistanceOfAVoxelAtTheCorner) {
  std::vector<BitGrid3> grids{BitGrid3({5, 4, 3}), random_voxels({6, 5, 7}, 1, 0, 1)};
  for (unsigned seed = 1; seed <= 12; ++seed)
    grids.push_back(random_voxels({9, 7, 8}, seed % 2 == 0 ? 0.9 : 0.6, 0, seed));
  std::set<std::int64_t> found;
  for (const BitGrid3& domain : grids) {
    const auto squares = squared_distance(domain, threads(), no_memory_limit);
    const auto l1 = l1_distance(domain, threads(), no_memory_limit);
    V3i c;
    for (c.z = 0; c.z <= domain.size().z; ++c.z)
      for (c.y = 0; c.y <= domain.size().y; ++c.y)
        for (c.x = 0; c.x <= domain.size().x; ++c.x) {
          const std::int64_t r2 = squared_voxel_radius(squares, c);
          ASSERT_EQ(r2, voxel_radius2_by_definition(domain, c)) << c;
          found.insert(r2);
          // Along each axis centres lie no nearer than the cubes, and by at most 1 farther.
          const std::int64_t ball2 = squared_ball_radius(l1, c);
          ASSERT_GE(r2, ball2) << c;
          ASSERT_LE(std::sqrt(double(r2)), std::sqrt(double(ball2)) + std::sqrt(3.0) + 1e-12) << c;
        }
  }
  EXPECT_GE(found.size(), 5u) << "the grids have few radii";
}

TEST(BuildGraph, ByVoxelsIsTheSameButForTheRadii) {
  for (const auto& [name, domain] : domains()) {
    const Space space = space_of(domain);
    const auto squares = squared_distance(domain, threads(), no_memory_limit);
    SkeletonGraph graph = graph_by_voxels(domain);
    for (std::uint32_t n = 0; n < graph.nodes(); ++n) {
      ASSERT_EQ(graph.squared_radius(n), squared_voxel_radius(squares, graph.corners[n])) << name;
      ASSERT_GE(graph.radii[n], 1) << name;
    }
    graph.radii = space.graph.radii;
    EXPECT_TRUE(same(graph, space.graph)) << name;
  }
  const Grid3<std::uint32_t> squares(V3i(4, 5, 7));
  EXPECT_THROW(build_graph_by_voxels(CubicalComplex(BitGrid3({4, 5, 6})), squares, threads()),
               std::invalid_argument);
}

TEST(BuildGraph, HasTheVerticesAndEdgesOfTheComplex) {
  for (const auto& [name, domain] : domains()) {
    const auto l1 = l1_distance(domain, threads(), no_memory_limit);
    const CubicalComplex complex = thinned(domain, l1);
    const SkeletonGraph graph = build_graph(complex, l1, threads());
    EXPECT_EQ(fault(graph), "") << name;
    EXPECT_EQ(graph.nodes(), complex.count(0)) << name;
    EXPECT_EQ(graph.edges(), complex.count(1)) << name;
    for (std::uint32_t n = 0; n < graph.nodes(); ++n) {
      const V3i c = graph.corners[n];
      ASSERT_TRUE(complex.has(c, 0)) << name << ' ' << c;
      if (n > 0) {
        const V3i b = graph.corners[n - 1];
        ASSERT_LT(std::tie(b.z, b.y, b.x), std::tie(c.z, c.y, c.x)) << name;
      }
      for (const std::uint32_t m : graph.of(n)) {
        const V3i low = std::min(n, m) == n ? c : graph.corners[m], d = graph.corners[m] - c;
        ASSERT_EQ(d.dot(d), 1) << name << ' ' << c;
        ASSERT_TRUE(complex.has(low, d.x != 0 ? 1 : d.y != 0 ? 2 : 4)) << name << ' ' << c;
      }
      ASSERT_EQ(graph.squared_radius(n), radius2_by_definition(domain, c)) << name << ' ' << c;
    }
  }
}

TEST(BuildGraph, IsTheSameForAnyNumberOfThreadsAndAnyPlaceInTheGrid) {
  for (const auto& [name, domain] : domains()) {
    const Space space = space_of(domain);
    EXPECT_TRUE(same(space.graph, build_graph(thinned(domain, space.l1), space.l1, ThreadPool(1))))
        << name;
    const V3i shift(3, 9, 5);
    EXPECT_TRUE(same(space.graph, moved_space(domain, shift).graph, shift)) << name;
  }
}

TEST(BuildGraph, RefusesSurfacesAndAnotherGrid) {
  const BitGrid3 domain = random_voxels({4, 5, 6}, 1, 0, 1);
  const auto l1 = l1_distance(domain, threads(), no_memory_limit);
  try {
    build_graph(CubicalComplex(domain), l1, threads());
    FAIL();
  } catch (const std::invalid_argument& e) {
    EXPECT_NE(std::string(e.what()).find("120 cubes"), std::string::npos) << e.what();
  }
  EXPECT_THROW(build_graph(CubicalComplex(BitGrid3({4, 5, 7})), l1, threads()),
               std::invalid_argument);
}

TEST(Adjacency, HasEachEdgeOnce) {
  const SkeletonGraph graph = make_graph({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 0, 0},
                                         {{2, 1}, {1, 2}, {1, 1}, {2, 0}, {2, 1}});
  EXPECT_EQ(fault(graph), "");
  EXPECT_EQ(graph.edges(), 2u);
  EXPECT_EQ(graph.degree(1), 1u);
  EXPECT_EQ(fault(make_graph({}, {}, {})), "");
}

}  // namespace
}  // namespace lacuna::testing
