// One shadow ray for all connections of an eye path.

#include "renderer/integrators/one_ray.h"

#include <gtest/gtest.h>

#include "tests/statistics.h"

namespace lacuna {
namespace {

struct TestContribution {
  std::uint8_t path = 0;
  Rgb value{0, 0, 0};
  float weight = 1;
};

struct TestQueue {
  std::vector<std::pair<Ray, TestContribution>> rays;
  void add(const Ray& ray, const TestContribution& c) { rays.emplace_back(ray, c); }
};

// The expectation of each channel is the sum of what is unoccluded; the ray with index 1 is not.
TEST(OneRay, HasTheMeanOfAll) {
  const std::array<TestContribution, 4> all{{{3, Rgb(1, 2, 3), 0.5F},
                                             {3, Rgb(5, 0.5F, 1), 1},
                                             {3, Rgb(0.1F, 4, 0), 0.25F},
                                             {3, Rgb(0, 0, 0), 1}}};
  std::array<statistics::Moments, 3> means;
  V3d expected(0.0);
  for (const std::size_t k : {0U, 2U}) expected += V3d(all[k].value * all[k].weight);
  TestQueue queue;
  OneRay<TestContribution> one;
  one.start(Rng(7, 0, 0, Rng::Purpose::test), 64);
  int rays = 0;
  for (int n = 0; n < 20000; ++n) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      const Ray ray{V3f(static_cast<float>(k)), V3f(0, 0, 1)};
      one.add(ray, all[k], queue);
    }
    EXPECT_TRUE(queue.rays.empty()) << "nothing is traced before the path is complete";
    one.finish(queue);
    V3d sum(0.0);
    for (const auto& [ray, c] : queue.rays) {
      ++rays;
      if (ray.o.x != 1) sum = V3d(c.value * c.weight);
    }
    queue.rays.clear();
    for (int k = 0; k < 3; ++k) means[static_cast<std::size_t>(k)].add(sum[k]);
  }
  EXPECT_EQ(rays, 20000);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(statistics::t_test(means[static_cast<std::size_t>(k)], expected[k]), 1e-4) << k;
  }
}

}  // namespace
}  // namespace lacuna
