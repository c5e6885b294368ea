#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>

#include "analysis/space/distance.h"
#include "analysis/space/memory_limit.h"
#include "tests/analysis/space/soups_and_grids.h"

namespace lacuna {
namespace {

using Imath::V3i;

/// The least measure(x - y) over all y outside the domain, one voxel round the grid included.
template <class Measure>
std::uint32_t distance_by_definition(const BitGrid3& domain, V3i x, Measure measure) {
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
  V3i y;
  for (y.z = -1; y.z <= domain.size().z; ++y.z)
    for (y.y = -1; y.y <= domain.size().y; ++y.y)
      for (y.x = -1; y.x <= domain.size().x; ++y.x)
        if (!in_grid(y, domain.size()) || !domain.get(y)) least = std::min(least, measure(x - y));
  return least;
}

std::uint32_t squared(V3i d) { return static_cast<std::uint32_t>(d.dot(d)); }

template <class T, class Measure>
void expect_by_definition(const BitGrid3& domain, const Grid3<T>& map, Measure measure) {
  for (std::size_t i = 0; i < map.count(); ++i)
    ASSERT_EQ(map[i], distance_by_definition(domain, map.voxel(i), measure))
        << "voxel " << map.voxel(i) << " of " << domain.size();
}

TEST(Distance, IsTheLeastOverAllVoxelsOutside) {
  for (const BitGrid3& domain : small_grids(1)) {
    expect_by_definition(domain, l1_distance(domain, one_thread(), no_memory_limit), l1);
    expect_by_definition(domain, chebyshev_distance(domain, one_thread(), no_memory_limit),
                         chebyshev);
    expect_by_definition(domain, squared_distance(domain, one_thread(), no_memory_limit), squared);
  }
}

template <class T>
void expect_equal(const Grid3<T>& a, const Grid3<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.count(); ++i) ASSERT_EQ(a[i], b[i]) << a.voxel(i);
}

TEST(Distance, HasTheSameBitsForAnyNumberOfThreads) {
  std::mt19937 rng(2);
  // Higher than wide: blocks of rows, several planes at a time, and the gaps between blocks.
  for (const BitGrid3& domain :
       {random_rooms({33, 150, 70}, 400, 9, rng), random_grid({20, 200, 40}, 0.999, rng),
        random_grid({5, 300, 35}, 1, rng)}) {
    const auto sums = l1_distance(domain, one_thread(), no_memory_limit);
    const auto largest = chebyshev_distance(domain, one_thread(), no_memory_limit);
    const auto squares = squared_distance(domain, one_thread(), no_memory_limit);
    expect_equal(sums, l1_distance(domain, four_threads(), no_memory_limit));
    expect_equal(largest, chebyshev_distance(domain, four_threads(), no_memory_limit));
    expect_equal(squares, squared_distance(domain, four_threads(), no_memory_limit));
  }
}

TEST(Distance, OfABoxWithoutSceneIsThatToItsFaces) {
  std::mt19937 rng(3);
  const BitGrid3 domain = random_grid({65, 70, 80}, 1, rng);
  const V3i n = domain.size();
  const auto map = chebyshev_distance(domain, four_threads(), no_memory_limit);
  const auto squares = squared_distance(domain, four_threads(), no_memory_limit);
  const auto sums = l1_distance(domain, four_threads(), no_memory_limit);
  for (std::size_t i = 0; i < map.count(); ++i) {
    const V3i v = map.voxel(i);
    const int d = std::min({v.x + 1, v.y + 1, v.z + 1, n.x - v.x, n.y - v.y, n.z - v.z});
    ASSERT_EQ(map[i], d);
    ASSERT_EQ(sums[i], d);
    ASSERT_EQ(squares[i], d * d);
  }
}

TEST(Distance, IsRefusedBeforeItTakesTooMuchMemory) {
  const BitGrid3 domain(V3i(64, 64, 64));
  EXPECT_NO_THROW(l1_distance(domain, one_thread(), 2 * 64 * 64 * 64));
  EXPECT_THROW(l1_distance(domain, one_thread(), 2 * 64 * 64 * 64 - 1), MemoryLimitError);
  EXPECT_THROW(chebyshev_distance(domain, one_thread(), 1000), MemoryLimitError);
  EXPECT_THROW(squared_distance(domain, one_thread(), 4 * 64 * 64 * 64 - 1), MemoryLimitError);
}

}  // namespace
}  // namespace lacuna
