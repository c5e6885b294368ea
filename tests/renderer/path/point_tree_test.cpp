#include "renderer/path/point_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "renderer/core/rng.h"

namespace lacuna {
namespace {

/// On two walls, a tenth of them in one spot.
std::vector<V3f> walls_and_a_spot(std::size_t n) {
  Rng rng(8, 0, 0, Rng::Purpose::test);
  std::vector<V3f> points;
  for (std::size_t i = 0; i < n; ++i) {
    const V2f at = rng.next2();
    points.push_back(rng.next() < 0.1F   ? V3f(0.5F, 0.5F, 0)
                     : rng.next() < 0.5F ? V3f(at.x, at.y, 0)
                                         : V3f(0, at.x, at.y));
  }
  return points;
}

/// The squared distances of the nearest points, in order.
std::vector<float> nearest_by_brute_force(const std::vector<V3f>& points, const V3f& x,
                                          float radius2, std::size_t most) {
  std::vector<float> all;
  for (const V3f& p : points) {
    if (const float d2 = (p - x).length2(); d2 < radius2) all.push_back(d2);
  }
  std::sort(all.begin(), all.end());
  all.resize(std::min(all.size(), most));
  return all;
}

TEST(PointTree, FindsWhatBruteForceFinds) {
  constexpr float all = std::numeric_limits<float>::infinity();
  Rng rng(9, 0, 0, Rng::Purpose::test);
  for (const std::size_t n : {0, 1, 8, 9, 100, 5000}) {
    const std::vector<V3f> points = walls_and_a_spot(n);
    PointTree tree;
    tree.build(points);
    for (int query = 0; query < 100; ++query) {
      const V3f x = query % 2 == 0 && n > 0 ? points[rng.below(n)]
                                            : V3f(rng.next(), rng.next(), rng.next() - 0.5F);
      for (const float radius2 : {all, 0.04F, 0.0004F}) {
        for (const std::size_t most : {1, 5, 64, 1000}) {
          std::vector<PointTree::Found> found(most);
          found.resize(tree.nearest(x, radius2, found));
          std::vector<float> distances;
          std::vector<std::uint32_t> indices;
          for (const auto& [distance2, index] : found) {
            ASSERT_LE(distance2, found[0].distance2) << "the first is the farthest";
            ASSERT_EQ(distance2, (points[index] - x).length2());
            distances.push_back(distance2);
            indices.push_back(index);
          }
          std::sort(distances.begin(), distances.end());
          ASSERT_EQ(distances, nearest_by_brute_force(points, x, radius2, most)) << n << " points";
          std::sort(indices.begin(), indices.end());
          ASSERT_EQ(std::unique(indices.begin(), indices.end()), indices.end());
        }
      }
    }
  }
}

}  // namespace
}  // namespace lacuna
