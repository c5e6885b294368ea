// The number of continuations against brute force.

#include "renderer/guides/efficiency_roulette.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lacuna {
namespace {

/// A pixel: one sample of a part that nothing changes, and a path of throughput T that goes on.
struct Toy {
  double variance, rays;                         // of the part
  double throughput, mean, square, rays_behind;  // and of one continuation

  /// Of `q` continuations: roulette below 1, `q` independent parts above it.
  double variance_of(double q) const {
    const double of_one = square - mean * mean;
    const double behind = q < 1 ? square / q - mean * mean : of_one / q;
    return variance + throughput * throughput * behind;
  }
  double rays_of(double q) const { return rays + q * rays_behind; }
  double expense(double q) const { return variance_of(q) * rays_of(q); }

  /// The fixed point of what EfficiencyRoulette advises.
  double advised() const {
    double q = 1;
    for (int i = 0; i < 200; ++i) {
      const double weight = throughput * std::sqrt(rays_of(q) / variance_of(q));
      const auto w = static_cast<float>(weight);
      q = double(EfficiencyRoulette::continuations(
          {static_cast<float>(mean), static_cast<float>(square), static_cast<float>(rays_behind)},
          w, w));
    }
    return q;
  }
  double best(double from, double to) const {
    double q = from;
    for (double x = from; x <= to; x += 1e-4) q = expense(x) < expense(q) ? x : q;
    return q;
  }
};

TEST(EfficiencyRoulette, AdvisesWhatBruteForceFinds) {
  for (const double square : {0.4, 1.0, 2.0}) {
    for (const double rays_behind : {2.0, 6.0}) {
      const Toy ends{4, 3, 1, 0.5, square, rays_behind};
      const double best = ends.best(1.0 / 3, 0.999);
      EXPECT_NEAR(ends.advised(), best, 2e-3) << square << ", " << rays_behind;
      EXPECT_LT(best, 0.95) << "the toy tells nothing";
    }
  }
  for (const double square : {40.0, 100.0}) {
    const Toy splits{30, 8, 1.5, 3, square, 2};
    const double best = splits.best(1, 7.9);
    EXPECT_NEAR(splits.advised(), best, 2e-3) << square;
    EXPECT_GT(best, 1.6) << "the toy tells nothing";
  }
}

TEST(EfficiencyRoulette, IsBounded) {
  EXPECT_EQ(EfficiencyRoulette::continuations({0, 0, 3}, 1, 1),
            EfficiencyRoulette::continuations({1e-6F, 1e-12F, 3}, 1, 1));
  EXPECT_GT(EfficiencyRoulette::continuations({0, 0, 3}, 1, 1), 0.2F);
  EXPECT_LE(EfficiencyRoulette::continuations({1, 1e20F, 3}, 1, 1), 16);
  // What has no variance is never split, whatever it gathers.
  EXPECT_EQ(EfficiencyRoulette::continuations({1e3F, 1e6F, 3}, 1, 1), 1);
}

}  // namespace
}  // namespace lacuna
