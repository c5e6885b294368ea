#include <gtest/gtest.h>

#include <limits>

#include "analysis/space/components.h"
#include "analysis/space/domain.h"
#include "analysis/space/memory_limit.h"
#include "tests/analysis/space/soups_and_grids.h"

namespace lacuna {
namespace {

using Imath::V3d;
using Imath::V3i;

Domain domain_of(const Voxels& voxels, const DomainSeeds& seeds) {
  return restrict_domain(voxels, seeds, one_thread(), no_memory_limit);
}

/// Two rooms of 6^3 voxels side by side along x behind walls of one voxel, in a grid of 17 x 10 x
/// 10 with an empty layer around.
Voxels two_rooms() {
  Voxels v{{}, BitGrid3(V3i(17, 10, 10))};
  for (int z = 1; z < 9; ++z)
    for (int y = 1; y < 9; ++y)
      for (int x = 1; x < 16; ++x)
        if (z == 1 || z == 8 || y == 1 || y == 8 || x == 1 || x == 8 || x == 15)
          v.scene.set(x, y, z);
  return v;
}
constexpr std::uint64_t room = 6 * 6 * 6, grid = 17 * 10 * 10, outside = grid - 15 * 8 * 8;
const V3i in_left(4, 4, 4), in_right(12, 4, 4), in_outside(0, 0, 0);

TEST(EmptyVoxels, AreThoseThatAreNotScene) {
  for (const BitGrid3& scene : small_grids(51)) {
    const BitGrid3 empty = empty_voxels(scene);
    for (int z = 0; z < scene.size().z; ++z)
      for (int y = 0; y < scene.size().y; ++y)
        for (int x = 0; x < scene.size().x; ++x) ASSERT_NE(empty.get(x, y, z), scene.get(x, y, z));
    const auto voxels = static_cast<std::size_t>(scene.size().x * scene.size().y * scene.size().z);
    ASSERT_EQ(empty.count() + scene.count(), voxels) << "bits beyond the size are to be 0";
  }
}

TEST(Domain, KeepsTheComponentOfASeed) {
  const Domain d = domain_of(two_rooms(), {.points = {{V3d(4.5), {}}}});
  EXPECT_TRUE(d.voxels.get(in_left));
  EXPECT_FALSE(d.voxels.get(in_right));
  EXPECT_FALSE(d.voxels.get(in_outside));
  EXPECT_EQ(d.voxels.count(), room);
  EXPECT_EQ(d.components_kept, 1u);
  EXPECT_EQ(d.components_dropped, 2u);
  EXPECT_EQ(d.voxels_kept, room);
  EXPECT_EQ(d.voxels_dropped, outside + room);
  EXPECT_EQ(d.seeds_buried, 0u);
}

TEST(Domain, WithoutSeedsIsEmpty) {
  const Domain d = domain_of(two_rooms(), {});
  EXPECT_EQ(d.voxels.count(), 0u);
  EXPECT_EQ(d.components_dropped, 3u);
}

TEST(Domain, OfLightFromInfinityOrOutsideTouchesTheBorder) {
  for (const DomainSeeds& seeds :
       {DomainSeeds{{}, true}, DomainSeeds{{{V3d(-40, 0, 0), {}}}, false},
        DomainSeeds{{{V3d(3, 3, 11), V3d(0, 0, -1)}}, false}}) {
    const Domain d = domain_of(two_rooms(), seeds);
    EXPECT_EQ(d.voxels.count(), outside);
    EXPECT_TRUE(d.voxels.get(in_outside));
  }
}

TEST(Domain, OfALightOnAWallIsOnTheSideThatEmits) {
  const V3d on_wall(8.5, 4.5, 4.5);  // between the rooms
  const auto kept = [&](V3d normal) {
    return domain_of(two_rooms(), {.points = {{on_wall, normal}}});
  };
  const Domain left = kept({-0.001, 0, 0}), right = kept({3, 0.1, 0});
  EXPECT_TRUE(left.voxels.get(in_left) && left.voxels.count() == room);
  EXPECT_TRUE(right.voxels.get(in_right) && right.voxels.count() == room);
  // At the foot of the wall only corners of the shell are empty.
  const Domain corner = domain_of(two_rooms(), {.points = {{{8.5, 1.5, 1.5}, V3d(1, 1, 1)}}});
  EXPECT_TRUE(corner.voxels.get(in_right) && corner.voxels.count() == room);
}

TEST(Domain, OfACameraInAWallIsOnBothSides) {
  const Domain d = domain_of(two_rooms(), {.points = {{{8.5, 4.5, 4.5}, {}}}});
  EXPECT_TRUE(d.voxels.get(in_left) && d.voxels.get(in_right));
  EXPECT_EQ(d.voxels.count(), 2 * room);
}

TEST(Domain, LooksFurtherForASeedInThickScene) {
  Voxels v{{}, BitGrid3(V3i(30, 30, 30))};
  for (int z = 0; z < 30; ++z)
    for (int y = 0; y < 30; ++y)
      for (int x = 3; x < 27; ++x) v.scene.set(x, y, z);
  const auto seed = [](double x, double nx) { return Seed{{x, 15.5, 15.5}, V3d(nx, 0.01, 0)}; };
  const Domain left = domain_of(v, {.points = {seed(6.5, -1)}});
  EXPECT_EQ(left.voxels.count(), 3u * 900);
  EXPECT_TRUE(left.voxels.get(0, 0, 0));
  EXPECT_EQ(left.seeds_buried, 0u);
  // 3 to 26 are scene: from 10 the nearest empty voxel is 8 away, from 11 it is 9.
  EXPECT_EQ(domain_of(v, {.points = {seed(10.5, -1)}}).seeds_buried, 0u);
  EXPECT_EQ(domain_of(v, {.points = {seed(11.5, -1), seed(15.5, 1)}}).seeds_buried, 2u);
}

TEST(Domain, OfALightOnTheGridsFaceThatShinesOutwardsIsTheOutside) {
  Voxels v{{}, BitGrid3(V3i(9))};
  for (int z = 0; z < 9; ++z)
    for (int y = 0; y < 9; ++y)
      for (int x = 0; x < 9; ++x)
        if (x == 8 || (x < 6 && (x == 0 || x == 5))) v.scene.set(x, y, z);
  // Empty: 1 to 4 and 6 to 7, both touch the border.
  const Domain out = domain_of(v, {.points = {{{9, 4, 4}, V3d(1, 0, 0)}}});
  EXPECT_EQ(out.components_kept, 2u);
  const Domain in = domain_of(v, {.points = {{{9, 4, 4}, V3d(-1, 0, 0)}}});
  EXPECT_EQ(in.components_kept, 1u);
  EXPECT_TRUE(in.voxels.get(7, 0, 0));
}

TEST(Domain, UsesTheTransformAndHasTheSameBitsForAnyNumberOfThreads) {
  std::mt19937 rng(52);
  Voxels v{{V3d(1e7, -50, 3), 0.25}, random_grid({60, 50, 40}, 0.9, rng)};
  std::uniform_real_distribution<double> u(0, 1);
  DomainSeeds seeds;
  for (int i = 0; i < 30; ++i)
    seeds.points.push_back({v.transform.to_world(V3d(60 * u(rng), 50 * u(rng), 40 * u(rng))), {}});
  const Domain one = domain_of(v, seeds);
  const Domain four = restrict_domain(v, seeds, four_threads(), no_memory_limit);
  EXPECT_EQ(one.voxels, four.voxels);
  EXPECT_GT(one.components_kept, 0u);
  EXPECT_GT(one.components_dropped, 0u);
  EXPECT_EQ(one.voxels.count(), one.voxels_kept);
  // A component is kept whole or not at all.
  const BitGrid3 empty = empty_voxels(v.scene);
  EXPECT_EQ(one.voxels_kept + one.voxels_dropped, empty.count());
  const Components c =
      connected_components(empty, Connectivity::corners, one_thread(), no_memory_limit);
  std::vector<std::uint64_t> kept(c.count(), 0);
  for (int z = 0; z < 40; ++z)
    for (int y = 0; y < 50; ++y)
      for (int x = 0; x < 60; ++x)
        if (one.voxels.get(x, y, z)) ++kept[c.at({x, y, z})];
  for (std::size_t i = 0; i < kept.size(); ++i) EXPECT_TRUE(kept[i] == 0 || kept[i] == c.voxels[i]);
}

TEST(Domain, RefusesBadSeedsAndTooMuchMemory) {
  const Voxels v = two_rooms();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(domain_of(v, {.points = {{V3d(nan, 0, 0), {}}}}), std::invalid_argument);
  EXPECT_THROW(domain_of(v, {.points = {{V3d(1), V3d(0)}}}), std::invalid_argument);
  EXPECT_THROW(domain_of(v, {.points = {{V3d(1), V3d(0, nan, 0)}}}), std::invalid_argument);
  EXPECT_THROW(restrict_domain(v, {}, one_thread(), 500), MemoryLimitError);
}

TEST(Domain, OfAFullGridIsEmpty) {
  Voxels v{{}, BitGrid3(V3i(1))};
  v.scene.set(0, 0, 0);
  const Domain d = domain_of(v, {.points = {{V3d(0.5), {}}}, .from_infinity = true});
  EXPECT_EQ(d.voxels.count(), 0u);
  EXPECT_EQ(d.components_kept + d.components_dropped, 0u);
}

}  // namespace
}  // namespace lacuna
