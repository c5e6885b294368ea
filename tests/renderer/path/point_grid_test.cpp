#include "renderer/path/point_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/statistics.h"

namespace lacuna {
namespace {

using Points = std::vector<V3f>;

Points on_two_walls(std::size_t n, float size) {
  Rng rng(5, 0, 0, Rng::Purpose::test);
  Points points;
  for (std::size_t i = 0; i < n; ++i) {
    const V2f at = rng.next2() * size - V2f(size / 3);
    points.push_back(rng.next() < 0.5F ? V3f(at.x, at.y, 0) : V3f(0, at.x, at.y));
  }
  return points;
}

PointGrid grid_of(const Points& points, double radius, int threads = 2) {
  PointGrid grid;
  grid.build(points, radius, ThreadPool(threads));
  return grid;
}

/// The indices of the points within `radius` of `x`, in order, and what each counts.
std::vector<std::uint32_t> found(const PointGrid& grid, const V3f& x, float radius,
                                 float* step = nullptr) {
  Rng rng(6, 0, 0, Rng::Purpose::test);
  std::vector<std::uint32_t> all;
  grid.for_each_within(x, radius, rng, [&](std::uint32_t k, float, float count) {
    all.push_back(grid.order()[k]);
    if (step != nullptr) *step = count;
  });
  std::sort(all.begin(), all.end());
  return all;
}
std::vector<std::uint32_t> by_brute_force(const Points& points, const V3f& x, float radius) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < points.size(); ++i) {
    const V3f d = points[i] - x;
    if (d.x * d.x + d.y * d.y + d.z * d.z <= radius * radius) all.push_back(i);
  }
  return all;
}

TEST(PointGrid, FindsWhatLiesWithinTheRadius) {
  struct Case {
    std::size_t points;
    float size, radius;
  };
  std::size_t seen = 0;
  for (const Case& c : {Case{1, 1, 0.1F}, Case{3, 1, 2}, Case{40, 1, 0.05F}, Case{3000, 1, 0.02F},
                        Case{3000, 1, 10}, Case{100000, 1, 0.001F}, Case{30000, 1e-4F, 2e-6F},
                        Case{30000, 1e5F, 2000}, Case{2000, 1, 0x1p-20F}}) {
    const Points points = on_two_walls(c.points, c.size);
    const PointGrid grid = grid_of(points, double(c.radius));
    Points queries(points.begin(),
                   points.begin() + std::min<std::ptrdiff_t>(300, std::ssize(points)));
    for (const V3f& q : on_two_walls(300, 1.1F * c.size)) queries.push_back(q + V3f(c.radius / 2));
    for (const V3f& q : queries) {
      for (const float radius : {c.radius, c.radius / 3}) {
        const auto expected = by_brute_force(points, q, radius);
        EXPECT_EQ(found(grid, q, radius), expected) << c.points << " points, radius " << radius;
        seen += expected.size();
      }
    }
  }
  EXPECT_GT(seen, 100000U) << "the test has no power";
}

TEST(PointGrid, IsEmptyWithoutPoints) {
  PointGrid grid;
  EXPECT_TRUE(found(grid, V3f(0), 1).empty());
  grid = grid_of({}, 1);
  EXPECT_TRUE(found(grid, V3f(0), 1).empty());
}

TEST(PointGrid, HasTheSameOrderForAnyNumberOfThreads) {
  const Points points = on_two_walls(200000, 1);
  const PointGrid one = grid_of(points, 0.003, 1), three = grid_of(points, 0.003, 3);
  EXPECT_TRUE(std::ranges::equal(one.order(), three.order()));
  std::vector<std::uint32_t> places(three.order().begin(), three.order().end());
  std::sort(places.begin(), places.end());
  for (std::uint32_t i = 0; i < places.size(); ++i) ASSERT_EQ(places[i], i);
}

// Where there are too many, some are visited, and count for the others.
TEST(PointGrid, BoundsWhatAQueryVisits) {
  constexpr std::uint32_t n = 100000;
  Points heap(n, V3f(0.25F, 0.5F, -3));
  const Points walls = on_two_walls(n, 1);
  for (const Points* points : {static_cast<const Points*>(&heap), &walls}) {
    const PointGrid grid = grid_of(*points, 100);
    float step = 0;
    const auto visited = found(grid, V3f(0.25F, 0.5F, -3), 100, &step);
    EXPECT_LE(visited.size(), PointGrid::most_candidates + 1);
    EXPECT_GT(step, 1);
    EXPECT_NEAR(double(step) * double(visited.size()), n, double(step));
  }
  // Of a sum over the visited, the mean is the sum over all.
  const PointGrid grid = grid_of(walls, 100);
  double all = 0;
  for (const V3f& p : walls) all += double(p.x);
  statistics::Moments sums;
  Rng rng(7, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 2000; ++i) {
    double sum = 0;
    grid.for_each_within(V3f(0), 100, rng, [&](std::uint32_t k, float, float count) {
      sum += double(count) * double(walls[grid.order()[k]].x);
    });
    sums.add(sum);
  }
  EXPECT_NEAR(sums.mean(), all, 4.5 * sums.standard_error());
  EXPECT_LT(sums.standard_error(), 0.01 * std::abs(all)) << "the test has no power";
}

}  // namespace
}  // namespace lacuna
