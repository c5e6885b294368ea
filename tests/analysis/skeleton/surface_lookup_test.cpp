#include "analysis/skeleton/surface_lookup.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "analysis/skeleton/node_map.h"
#include "tests/analysis/skeleton/skeletons.h"

namespace lacuna::testing {
namespace {

using Imath::V3d;
using Imath::V3i;

/// A map where every voxel of the domain has a node of its own: its index.
Grid3<std::uint32_t> indices(const BitGrid3& domain) {
  Grid3<std::uint32_t> map(domain.size());
  for (std::size_t i = 0; i < map.count(); ++i)
    map[i] = domain.get(map.voxel(i)) ? static_cast<std::uint32_t>(i) : no_node;
  return map;
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Two rooms, x < 4 and x > 6, and a wall of three voxels.
BitGrid3 wall() {
  BitGrid3 domain({11, 9, 9});
  add_box(domain, {0, 0, 0}, {4, 9, 9});
  add_box(domain, {7, 0, 0}, {11, 9, 9});
  return domain;
}

TEST(SurfaceLookup, TakesTheVoxelAlongTheNormalOnTheSideOfTheViewer) {
  const GridTransform transform{.origin = {100, -50, 7}, .voxel_size = 0.25};
  const BitGrid3 domain = wall();
  const auto map = indices(domain);
  const SurfaceLookup lookup(transform, map);
  const auto at = [&](V3d p) { return transform.to_world(p); };
  // On the wall's left face, seen from the left, with the normal to either side.
  for (const double side : {-1.0, 1.0})
    EXPECT_EQ(lookup.voxel(at({4.1, 4.5, 4.5}), {side, 0, 0}, {-3, 1, 0}), V3i(3, 4, 4));
  EXPECT_EQ(lookup.voxel(at({6.9, 4.5, 4.5}), {1, 0, 0}, {0.1, 0, 0}), V3i(7, 4, 4));
  // An oblique normal: the diagonal neighbour has the larger product.
  EXPECT_EQ(lookup.voxel(at({4.1, 4.5, 4.5}), {-1, 0.9, 0}, {-1, 0, 0}), V3i(3, 5, 4));
  EXPECT_EQ(lookup.voxel(at({4.1, 4.5, 4.5}), {-1, 0, 1e-6}, {-1, 0, 0}), V3i(3, 4, 5));
  EXPECT_EQ(lookup.node(at({4.1, 4.5, 4.5}), {-1, 0, 0}, {-1, 0, 0}), map.index(3, 4, 4));
}

TEST(SurfaceLookup, PrefetchesWhatItMostOftenTakes) {
  const BitGrid3 domain = wall();
  const auto map = indices(domain);
  const SurfaceLookup lookup({}, map);
  const auto expect_taken = [&](const V3d& x, const V3d& n, const V3d& w) {
    const auto voxel = lookup.voxel(x, n, w);
    ASSERT_TRUE(voxel);
    EXPECT_EQ(lookup.prefetch(x, n, w), map.index(*voxel));
  };
  for (const double side : {-1.0, 1.0}) expect_taken({4.1, 4.5, 4.5}, {side, 0, 0}, {-3, 1, 0});
  expect_taken({6.9, 4.5, 4.5}, {1, 0, 0}, {0.1, 0, 0});
  expect_taken({4.1, 4.5, 4.5}, {-1, 0.9, 0.2}, {-1, 0, 0});
  EXPECT_EQ(lookup.prefetch({4.1, -3, 4.5}, {1, 0, 0}, {1, 0, 0}), std::nullopt);
  EXPECT_TRUE(lookup.prefetch({0, 0, 0}, {-1, 0, 0}, {-1, 0, 0}))
      << "what is in front lies outside";
}

TEST(SurfaceLookup, WidensTheShellButNotToWhatLiesBehind) {
  const BitGrid3 domain = wall();
  const auto map = indices(domain);
  const SurfaceLookup lookup({}, map);
  // From the middle of the wall no neighbour is empty.
  EXPECT_EQ(lookup.voxel({5.5, 4.5, 4.5}, {1, 0, 0}, {1, 0, 0}), V3i(7, 4, 4));
  EXPECT_EQ(lookup.voxel({5.5, 4.5, 4.5}, {1, 0, 0}, {-1, 0, 0}), V3i(3, 4, 4));
  // On the left face, seen from the right: not the near room behind, but the far one in front.
  EXPECT_EQ(lookup.voxel({4.5, 4.5, 4.5}, {1, 0, 0}, {1, 0, 0}), V3i(7, 4, 4));
  // Along the wall: the first of the two nearest in front, in the second shell.
  EXPECT_EQ(lookup.voxel({5.5, 4.5, 4.5}, {0, 1, 0}, {0, 1, 0}), V3i(3, 6, 4));
}

TEST(SurfaceLookup, GivesUpAtItsReach) {
  BitGrid3 domain({40, 3, 3});
  add_box(domain, {0, 0, 0}, {1, 3, 3});
  const auto map = indices(domain);
  const SurfaceLookup lookup({}, map);
  EXPECT_EQ(lookup.voxel({lookup_reach + 0.5, 1.5, 1.5}, {-1, 0, 0}, {-1, 0, 0}), V3i(0, 1, 1));
  EXPECT_EQ(lookup.node({lookup_reach + 1.5, 1.5, 1.5}, {-1, 0, 0}, {-1, 0, 0}), no_node);
}

TEST(SurfaceLookup, TakesAMappedVoxelAsItIs) {
  const BitGrid3 domain = wall();
  const auto map = indices(domain);
  EXPECT_EQ(SurfaceLookup({}, map).voxel({2.5, 3.5, 4.5}, {1, 0, 0}, {1, 0, 0}), V3i(2, 3, 4));
}

TEST(SurfaceLookup, FollowsEq154WhereANeighbourLiesInFront) {
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  const BitGrid3 domain = random_voxels({12, 11, 13}, 0.35, 0, 9);
  const auto map = indices(domain);
  const SurfaceLookup lookup({}, map);
  int followed = 0;
  for (int i = 0; i < 2000; ++i) {
    const V3i s(static_cast<int>(random() % 12), static_cast<int>(random() % 11),
                static_cast<int>(random() % 13));
    if (domain.get(s)) continue;
    const V3d n(gauss(random), gauss(random), gauss(random)),
        w(gauss(random), gauss(random), gauss(random));
    const V3d front = n.dot(w) >= 0 ? n : -n;
    double best = 0;
    std::optional<V3i> expected;
    for (int k = 0; k < 27; ++k) {
      const V3i d(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (k == 13 || !in_grid(s + d, domain.size()) || !domain.get(s + d)) continue;
      if (V3d(d).dot(front) > best) best = V3d(d).dot(front), expected = s + d;
    }
    if (!expected) continue;
    ++followed;
    ASSERT_EQ(lookup.voxel(V3d(s) + V3d(0.5), n, w), expected);
  }
  EXPECT_GT(followed, 1000);
}

TEST(SurfaceLookup, AnswersNoNodeToWhatIsNoPointOrNoNormal) {
  const BitGrid3 domain = wall();
  const auto map = indices(domain);
  const SurfaceLookup lookup({}, map);
  const V3d p(4.5, 4.5, 4.5), n(-1, 0, 0);
  ASSERT_NE(lookup.node(p, n, n), no_node);
  for (const double bad : {nan, infinity, -infinity}) {
    EXPECT_EQ(lookup.node({4.5, bad, 4.5}, n, n), no_node);
    EXPECT_EQ(lookup.node(p, {-1, bad, 0}, n), no_node);
    EXPECT_EQ(lookup.node(p, n, {-1, 0, bad}), no_node);
  }
  EXPECT_EQ(lookup.node(p, {0, 0, 0}, n), no_node);
  EXPECT_EQ(lookup.node({1e300, 4, 4}, n, n), no_node);
}

TEST(SurfaceLookup, TakesPointsAtTheRimToTheOutermostVoxels) {
  const BitGrid3 domain = wall();
  const auto map = indices(domain);
  const SurfaceLookup lookup({}, map);
  const V3d n(1, 0, 0);
  EXPECT_EQ(lookup.voxel({-0.4, 4.5, 4.5}, n, n), V3i(0, 4, 4));
  EXPECT_EQ(lookup.voxel({11.4, 9.0, 9.2}, n, n), V3i(10, 8, 8));
  EXPECT_EQ(lookup.voxel({11.6, 4.5, 4.5}, n, n), std::nullopt);
  const Grid3<std::uint32_t> nothing{V3i(0)};
  EXPECT_EQ(SurfaceLookup({}, nothing).node({0, 0, 0}, n, n), no_node);
}

}  // namespace
}  // namespace lacuna::testing
