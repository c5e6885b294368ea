#include "renderer/many_lights/split_points.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/core/rng.h"

namespace lacuna {
namespace {

std::vector<SurfacePoint> random_points(std::size_t n, float scale) {
  Rng rng(1, 0, 0, Rng::Purpose::test);
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < n; ++i) {
    const V3f x(rng.next() * scale, rng.next() * scale, rng.next() * scale);
    points.push_back({x, V3f(rng.next() - 0.5F, rng.next() - 0.5F, 1).normalized()});
  }
  return points;
}

void expect_partition(const std::vector<std::vector<std::uint32_t>>& groups, std::size_t n) {
  std::vector<int> seen(n, 0);
  for (const auto& g : groups) {
    EXPECT_FALSE(g.empty());
    for (const std::uint32_t i : g) ++seen[i];
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), static_cast<std::ptrdiff_t>(n));
}

TEST(SplitPoints, PutsEveryPlaceIntoOneOfAsManyGroupsAsAsked) {
  for (const float scale : {1e-4F, 1.0F, 1e5F}) {
    const auto points = random_points(1000, scale);
    for (const std::size_t parts : {1U, 2U, 37U, 999U, 1000U}) {
      const auto groups = split_points(points, parts, scale);
      EXPECT_EQ(groups.size(), parts);
      expect_partition(groups, points.size());
    }
    EXPECT_EQ(split_points(points, 5000, scale).size(), 1000U);
  }
}

TEST(SplitPoints, IsTheSameAtEveryScale) {
  const auto small = split_points(random_points(500, 1), 40, 1);
  EXPECT_EQ(small, split_points(random_points(500, 0x1p14F), 40, 0x1p14F));
}

TEST(SplitPoints, LeavesWhatIsAlikeTogether) {
  const std::vector<SurfacePoint> same(50, {V3f(1, 2, 3), V3f(0, 0, 1)});
  EXPECT_EQ(split_points(same, 10, 1).size(), 1U);
  EXPECT_EQ(split_points(same, 10, 0).size(), 1U);
  EXPECT_TRUE(split_points({}, 10, 1).empty());
}

// Two walls that meet: first the corner is split, by normal.
TEST(SplitPoints, SplitsByNormalToo) {
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 100; ++i) {
    const float t = static_cast<float>(i) / 1000;
    points.push_back(i % 2 == 0 ? SurfacePoint{V3f(t, 0, 0), V3f(0, 1, 0)}
                                : SurfacePoint{V3f(0, t, 0), V3f(1, 0, 0)});
  }
  for (const auto& group : split_points(points, 2, 1)) {
    for (const std::uint32_t i : group) EXPECT_EQ(i % 2, group[0] % 2);
  }
}

}  // namespace
}  // namespace lacuna
