#include "jobs/report/replicate_bias.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/statistics.h"

namespace lacuna {
namespace {

constexpr int side = 96;
constexpr std::size_t values = 3 * side * side;

/// Pictures of one method: the reference, a bias, and noise of deviation `noise`.
ReplicateBias pictures(std::mt19937_64& random, int n, double bias, double noise,
                       double reference_noise = 0) {
  std::normal_distribution<double> normal;
  std::vector<double> reference(values, 1.0);
  for (double& r : reference) r += reference_noise * normal(random);
  ReplicateBias b(reference, side);
  for (int i = 0; i < n; ++i) {
    std::vector<double> picture(values);
    for (double& v : picture) v = 1 + bias + noise * normal(random);
    b.add(picture);
  }
  return b;
}

TEST(ReplicateBias, TellsBiasFromVariance) {
  std::mt19937_64 random(7);
  const auto b = pictures(random, 4, 0.05, 0.5);
  const Estimate e = *b.bias_squared(std::nullopt);
  EXPECT_GT(e.interval->low, 0);
  EXPECT_LT(e.interval->low, 0.05 * 0.05);
  EXPECT_GT(e.interval->high, 0.05 * 0.05);
}

TEST(ReplicateBias, OfAnUnbiasedMethodIsZeroAsOftenAsItSays) {
  std::mt19937_64 random(8);
  int held = 0;
  constexpr int trials = 400;
  for (int i = 0; i < trials; ++i) {
    const Estimate e = *pictures(random, 3, 0, 0.3).bias_squared(std::nullopt);
    held += e.interval->low <= 0 && 0 <= e.interval->high ? 1 : 0;
  }
  const double z =
      (held / double(trials) - confidence) / std::sqrt(confidence * (1 - confidence) / trials);
  EXPECT_GT(statistics::two_sided_p(z), 1e-4) << held << " of " << trials;
}

TEST(ReplicateBias, TheReferencesOwnNoiseIsTakenAway) {
  std::mt19937_64 random(9);
  const auto b = pictures(random, 3, 0, 0.3, 0.1);
  EXPECT_GT(b.bias_squared(std::nullopt)->interval->low, 0);
  const Estimate e = *b.bias_squared(0.01);
  // Of 27648 values: noise of pairs, 0.3^2 / sqrt(3 / 2), and of the reference times that of the
  // mean.
  const double deviation = std::sqrt((0.0027 + 0.01 * 0.09 * 4 / 3 + 2e-4) / values);
  EXPECT_LT(std::abs(e.value), 5 * deviation);
}

TEST(ReplicateBias, OfOnePictureNothingIsKnown) {
  std::mt19937_64 random(10);
  EXPECT_FALSE(pictures(random, 1, 0, 1).bias_squared(std::nullopt));
  ReplicateBias b(std::vector<double>(values, 0.0), side);
  EXPECT_THROW(b.add(std::vector<double>(3)), std::invalid_argument);
}

}  // namespace
}  // namespace lacuna
