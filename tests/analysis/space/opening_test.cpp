#include <gtest/gtest.h>

#include <cstdlib>

#include "analysis/space/distance.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/opening.h"
#include "analysis/space/opening_query.h"
#include "tests/analysis/space/soups_and_grids.h"

namespace lacuna {
namespace {

using Imath::V3i;

/// The largest D(y) of all balls that hold each voxel, from all pairs.
template <class Distance>
std::vector<std::uint16_t> opening_by_definition(const Grid3<std::uint16_t>& d, Distance distance) {
  std::vector<std::uint16_t> opening(d.count(), 0);
  for (std::size_t j = 0; j < d.count(); ++j) {
    if (d[j] == 0) continue;
    for (std::size_t i = 0; i < d.count(); ++i)
      if (distance(d.voxel(i) - d.voxel(j)) < d[j]) opening[i] = std::max(opening[i], d[j]);
  }
  return opening;
}

std::vector<BitGrid3> grids() {
  std::vector<BitGrid3> all = small_grids(5);
  std::mt19937 rng(6);
  for (int i = 0; i < 6; ++i) all.push_back(random_rooms({19, 17, 15}, 14, 7, rng));
  all.push_back(random_grid({18, 16, 17}, 0.999, rng));
  return all;
}

TEST(OpeningForest, IsTheOpeningMapAndAForestOfItsBalls) {
  for (const BitGrid3& domain : grids()) {
    const auto d = chebyshev_distance(domain, one_thread(), no_memory_limit);
    const OpeningForest forest = opening_forest(d, one_thread(), no_memory_limit);
    const auto expected = opening_by_definition(d, chebyshev);
    for (std::size_t i = 0; i < d.count(); ++i) {
      ASSERT_EQ(forest.opening[i], expected[i]) << d.voxel(i) << " of " << d.size();
      const std::uint32_t c = forest.centre[i];
      ASSERT_EQ(c == no_voxel, d[i] == 0);
      if (c == no_voxel) continue;
      ASSERT_EQ(c == i, forest.opening[i] == d[i]) << "eq. 181 at " << d.voxel(i);
      ASSERT_EQ(d[c], forest.opening[i]) << "eq. 182 at " << d.voxel(i);
      ASSERT_LT(chebyshev(d.voxel(i) - d.voxel(c)), d[c]) << "eq. 182 at " << d.voxel(i);
    }
  }
}

TEST(OpeningForest, HasTheSameBitsForAnyNumberOfThreads) {
  std::mt19937 rng(7);
  const BitGrid3 domain = random_rooms({70, 45, 50}, 60, 12, rng);
  const auto d = chebyshev_distance(domain, one_thread(), no_memory_limit);
  const OpeningForest a = opening_forest(d, one_thread(), no_memory_limit),
                      b = opening_forest(d, four_threads(), no_memory_limit);
  for (std::size_t i = 0; i < d.count(); ++i) {
    ASSERT_EQ(a.opening[i], b.opening[i]);
    ASSERT_EQ(a.centre[i], b.centre[i]);
  }
}

TEST(OpeningForest, IsRefusedBeforeItTakesTooMuchMemory) {
  std::mt19937 rng(8);
  const BitGrid3 domain = random_grid({10, 10, 10}, 1, rng);
  const auto d = chebyshev_distance(domain, one_thread(), no_memory_limit);
  EXPECT_NO_THROW(opening_forest(d, one_thread(), 6000));
  EXPECT_THROW(opening_forest(d, one_thread(), 5999), MemoryLimitError);
}

TEST(OpeningQuery, IsTheLargestL1BallOverAVoxel) {
  for (const BitGrid3& domain : grids()) {
    const auto d = l1_distance(domain, one_thread(), no_memory_limit);
    const OpeningQuery query(d, four_threads());
    const auto expected = opening_by_definition(d, l1);
    for (std::size_t i = 0; i < d.count(); ++i) {
      ASSERT_EQ(query(d.voxel(i)), expected[i]) << d.voxel(i) << " of " << d.size();
      for (const int radius : {1, expected[i] - 1, static_cast<int>(expected[i]), expected[i] + 1})
        if (radius > 0) {
          ASSERT_EQ(query.reaches(d.voxel(i), radius), radius <= expected[i])
              << radius << " at " << d.voxel(i) << " of " << d.size();
        }
    }
  }
}

// Larger than a tile of 64 voxels: the answer lies in another tile.
TEST(OpeningQuery, FindsBallsInOtherTiles) {
  std::mt19937 rng(9);
  const BitGrid3 domain = random_rooms({150, 140, 70}, 40, 40, rng);
  const auto d = l1_distance(domain, four_threads(), no_memory_limit);
  const OpeningQuery query(d, four_threads());
  std::uniform_int_distribution<std::size_t> any(0, d.count() - 1);
  for (int k = 0; k < 40; ++k) {
    const V3i x = d.voxel(any(rng));
    std::uint16_t expected = 0;
    for (std::size_t j = 0; j < d.count(); ++j)
      if (d[j] > expected && l1(x - d.voxel(j)) < d[j]) expected = d[j];
    ASSERT_EQ(query(x), expected) << x;
    ASSERT_FALSE(query.reaches(x, expected + 1)) << x;
    ASSERT_TRUE(expected == 0 || query.reaches(x, expected)) << x;
  }
}

}  // namespace
}  // namespace lacuna
