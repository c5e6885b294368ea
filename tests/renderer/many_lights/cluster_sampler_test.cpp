// Sampling by clusters: which lights, how often, and what their sums come to.

#include "renderer/many_lights/cluster_sampler.h"

#include <map>

#include "tests/renderer/many_lights/sampled_means.h"

namespace lacuna {
namespace {

using test::expect_means_of_all;
using test::gathered;
using test::LitScene;

float one(std::uint32_t, std::size_t) { return 1; }
/// Rates that have nothing to do with visibility.
float made_up(std::uint32_t cell, std::size_t block) {
  return std::ldexp(1.0F, -static_cast<int>((7 * cell + 3 * block) % 11));
}

/// Exact visibility with such rates.
struct Misled : ExactVisibility {
  using ExactVisibility::ExactVisibility;
  static float rate(std::uint32_t, std::size_t block) { return made_up(5, block); }
};

// The probability of a light is the inverse of its weight.
TEST(ClusterSampler, SamplesByItsProbabilities) {
  for (const char* scene : {"ajar", "coated_points"}) {
    const LitScene lit({scene}, 40, 2);
    const VplTree tree(lit.lights(), lit.pool());
    constexpr int rounds = 30000;
    const std::vector<std::uint32_t> cells{5};
    lit.with_points(500, [&](std::span<const ShadingPoint> points) {
      for (const auto rate : {one, made_up}) {
        const ClusterSampler sampler(lit.terms(), tree, {.lights = 1, .nodes = 20});
        std::map<std::pair<std::size_t, std::uint64_t>, std::pair<double, double>> lights;
        for (int r = 0; r < rounds; ++r) {
          const auto samples = sampler.sample(
              points.first(1), lit.context(static_cast<std::uint64_t>(r)), {cells, rate});
          ASSERT_EQ(samples.size(), 1U);
          auto& [count, probability] = lights[{samples[0].block, samples[0].lights}];
          ++count;
          probability = 1 / double(samples[0].weight);
        }
        std::vector<double> observed, expected;
        double rest = 1;
        for (const auto& [light, found] : lights) {
          observed.push_back(found.first);
          expected.push_back(rounds * found.second);
          rest -= found.second;
        }
        observed.push_back(0);  // lights that were never sampled
        expected.push_back(std::max(0.0, rounds * rest));
        EXPECT_GT(lights.size(), 10U);
        const auto result = statistics::chi_square_test(observed, expected);
        EXPECT_GT(result.p, statistics::sidak(1e-5, 4)) << result.message;
      }
    });
  }
}

// Of very many samples at equal steps each light gets its share.
TEST(ClusterSampler, OfManySamplesIsTheSumOfAll) {
  for (const char* scene : {"ajar", "atrium", "coated_points"}) {
    SCOPED_TRACE(scene);
    const LitScene lit({scene}, 200, 2);
    const VplTree tree(lit.lights(), lit.pool());
    const ClusterSampler sampler(lit.terms(), tree, {.lights = 1 << 18, .nodes = 40});
    lit.with_points(400, [&](std::span<const ShadingPoint> points) {
      const ExactVisibility exact{{}};
      const auto all = gathered(lit, lit.context(1), exact, points);
      const auto sums = gathered(lit, lit.context(1), exact, points, nullptr, {&sampler});
      for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR(sums[i], all[i], 0.01 * all[i]);
    });
  }
}

TEST(ClusterSampler, SumsHaveTheMeanOfAll) {
  for (const char* scene : {"ajar", "coated_points"}) {
    SCOPED_TRACE(scene);
    const LitScene lit({scene}, 200, 2);
    const VplTree tree(lit.lights(), lit.pool());
    const ClusterSampler sampler(lit.terms(), tree, {.lights = 20, .nodes = 40});
    expect_means_of_all(lit, {&sampler});
  }
}

TEST(ClusterSampler, SumsHaveTheMeanOfAllWithWrongRates) {
  const LitScene lit({"ajar"}, 200, 2);
  const VplTree tree(lit.lights(), lit.pool());
  const ClusterSampler sampler(lit.terms(), tree, {.lights = 20, .nodes = 40});
  expect_means_of_all<Misled>(lit, {&sampler});
}

}  // namespace
}  // namespace lacuna
