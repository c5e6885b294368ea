#include "renderer/path/record_tree.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/core/rng.h"

namespace lacuna {
namespace {

V3f random_normal(Rng& rng) {
  const V2f u = rng.next2();
  const float z = 2 * u.x - 1, r = std::sqrt(1 - z * z);
  return {r * std::cos(6.2831853F * u.y), r * std::sin(6.2831853F * u.y), z};
}

std::vector<SurfacePoint> random_points(Rng& rng, std::size_t n) {
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < n; ++i) {
    const V2f at = rng.next2();
    // Most lie on two walls, some in one spot.
    const V3f x = rng.next() < 0.1F   ? V3f(0.5F, 0.5F, 0)
                  : rng.next() < 0.5F ? V3f(at.x, at.y, 0)
                                      : V3f(0, at.x, at.y);
    points.push_back({x, random_normal(rng)});
  }
  return points;
}

double cost(const SurfacePoint& at, const SurfacePoint& p) {
  return (V3d(at.x) - V3d(p.x)).length() * (2 - V3d(at.n).dot(V3d(p.n)));
}

/// What nearest() promises, as distances: equals may be found in any order.
std::vector<double> lowest_costs(const std::vector<SurfacePoint>& points, const SurfacePoint& at,
                                 std::size_t wanted) {
  std::vector<SurfacePoint> near = points;
  std::stable_sort(near.begin(), near.end(), [&](const SurfacePoint& a, const SurfacePoint& b) {
    return (V3d(at.x) - V3d(a.x)).length2() < (V3d(at.x) - V3d(b.x)).length2();
  });
  near.resize(std::min(near.size(), 2 * wanted));
  std::vector<double> costs;
  costs.reserve(near.size());
  for (const SurfacePoint& p : near) costs.push_back(cost(at, p));
  std::sort(costs.begin(), costs.end());
  costs.resize(std::min(costs.size(), wanted));
  return costs;
}

TEST(RecordTree, FindsWhatBruteForceFinds) {
  Rng rng(91, 0, 0, Rng::Purpose::test);
  int compared = 0;
  for (const std::size_t n : {1, 2, 5, 100, 3000}) {
    const std::vector<SurfacePoint> points = random_points(rng, n);
    RecordTree tree;
    tree.build(points);
    for (int query = 0; query < 50; ++query) {
      const SurfacePoint at{V3f(rng.next(), rng.next(), rng.next()), random_normal(rng)};
      for (const std::size_t wanted : {1, 3, 8, 64}) {
        std::vector<std::uint32_t> found(wanted, ~0U);
        const std::size_t count = tree.nearest(at, found);
        ASSERT_EQ(count, std::min(n, wanted));
        std::vector<std::uint32_t> once(found.begin(),
                                        found.begin() + static_cast<std::ptrdiff_t>(count));
        std::sort(once.begin(), once.end());
        EXPECT_EQ(std::unique(once.begin(), once.end()), once.end()) << "one was found twice";
        // Places in one spot are equally near: which of them are candidates is not said.
        const std::vector<double> expected = lowest_costs(points, at, wanted);
        const double spot = (V3d(at.x) - V3d(0.5, 0.5, 0)).length();
        for (std::size_t i = 0; i < count; ++i) {
          ASSERT_LT(found[i], n);
          if (expected.back() >= spot) continue;
          EXPECT_NEAR(cost(at, points[found[i]]), expected[i], 1e-5) << i << " of " << count;
          ++compared;
        }
      }
    }
  }
  EXPECT_GT(compared, 1000);
}

TEST(RecordTree, PrefersWhatFacesTheSameWay) {
  RecordTree tree;
  const V3f up(0, 1, 0);
  tree.build({{{1, 0, 0}, -up}, {{1.5F, 0, 0}, up}, {{9, 0, 0}, up}, {{9, 0, 1}, up}});
  std::array<std::uint32_t, 2> found{};
  ASSERT_EQ(tree.nearest({V3f(0, 0, 0), up}, found), 2U);
  EXPECT_EQ(found[0], 1U);  // 1.5 times 1
  EXPECT_EQ(found[1], 0U);  // 1 times 3
}

TEST(RecordTree, OfNothingFindsNothing) {
  RecordTree tree;
  std::array<std::uint32_t, 3> found{};
  EXPECT_EQ(tree.nearest({V3f(0, 0, 0), V3f(0, 1, 0)}, found), 0U);
  tree.build({{V3f(0, 0, 0), V3f(0, 1, 0)}});
  EXPECT_EQ(tree.nearest({V3f(0, 0, 0), V3f(0, 1, 0)}, found), 1U);
  tree.build({});
  EXPECT_EQ(tree.nearest({V3f(0, 0, 0), V3f(0, 1, 0)}, found), 0U) << "what was built before stays";
}

}  // namespace
}  // namespace lacuna
