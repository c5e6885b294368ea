#include "renderer/film/pareto_tail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace lacuna {
namespace {

/// `n` values of a generalized Pareto distribution of shape `k`, ascending.
std::vector<double> pareto(double k, int n, std::uint64_t seed, double scale = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i)
    values.push_back(scale * std::expm1(-k * std::log1p(-uniform(random))) / k);
  std::sort(values.begin(), values.end());
  return values;
}

TEST(ParetoTail, FindsTheShape) {
  constexpr int replicates = 200;
  for (const double k : {-0.5, 0.2, 0.7, 1.5}) {
    double mean = 0, squares = 0;
    for (std::uint64_t seed = 0; seed < replicates; ++seed) {
      const auto values = pareto(k, 10000, seed);
      const auto tail = pareto_tail(values, values.size());
      ASSERT_TRUE(tail);
      // Without the pull of ten values towards 1/2: the fit itself, of 300 values.
      const double fit = (tail->index * 310 - 5) / 300;
      mean += fit / replicates;
      squares += fit * fit / replicates;
    }
    const double deviation = std::sqrt(squares - mean * mean);
    EXPECT_NEAR(mean, k, 4 * deviation / std::sqrt(replicates) + 0.02)
        << k;  // its own bias: 1 / 300
    EXPECT_NEAR(deviation, std::max((1 + k), 0.6) / std::sqrt(300.0), 0.03)
        << k;  // as a likelihood's
  }
}

TEST(ParetoTail, SaysWhichMeansAreKnown) {
  const auto share_known = [](double k, int n) {
    int known = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      const auto values = pareto(k, n, seed);
      known += pareto_tail(values, values.size())->mean_is_known() ? 1 : 0;
    }
    return known / 200.0;
  };
  EXPECT_GT(share_known(0.1, 1000), 0.98);
  EXPECT_GT(share_known(-0.5, 100), 0.9);
  EXPECT_LT(share_known(1.2, 1000), 0.02);
  EXPECT_LT(share_known(1.2, 100), 0.1);
}

TEST(ParetoTail, IsThatOfTheValuesWhateverTheirScale) {
  const auto values = pareto(0.4, 1000, 3), dark = pareto(0.4, 1000, 3, 1e-280),
             bright = pareto(0.4, 1000, 3, 1e280);
  const double index = pareto_tail(values, 1000)->index;
  EXPECT_NEAR(pareto_tail(dark, 1000)->index, index, 1e-9);
  EXPECT_NEAR(pareto_tail(bright, 1000)->index, index, 1e-9);
}

TEST(ParetoTail, TheLargestAreEnough) {
  const auto values = pareto(0.4, 100000, 3);
  const std::span<const double> largest = std::span(values).last(4096);
  EXPECT_EQ(pareto_tail(largest, 100000)->index, pareto_tail(values, 100000)->index);
}

TEST(ParetoTail, OfFewOrEqualValuesThereIsNone) {
  const auto values = pareto(0.4, least_for_a_tail, 3);
  EXPECT_TRUE(pareto_tail(values, least_for_a_tail));
  EXPECT_FALSE(pareto_tail(values, least_for_a_tail - 1));
  EXPECT_FALSE(pareto_tail(std::vector<double>(200, 0.0), 200));
  EXPECT_FALSE(pareto_tail(std::vector<double>(200, 3.5), 200));
  EXPECT_FALSE(pareto_tail({}, 0));
}

TEST(ParetoTail, AFewValuesAmongZerosAreNotKnown) {
  std::vector<double> values(200, 0.0);
  values.back() = 1;
  ASSERT_TRUE(pareto_tail(values, 200));
  EXPECT_FALSE(pareto_tail(values, 200)->mean_is_known());
}

}  // namespace
}  // namespace lacuna
