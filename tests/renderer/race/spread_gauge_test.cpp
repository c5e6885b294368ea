#include "renderer/race/spread_gauge.h"

#include <gtest/gtest.h>

#include "base/storage/bytes.h"
#include "renderer/core/rng.h"

namespace lacuna {
namespace {

constexpr int gauge_side = 64, gauge_samples = 16;
/// Of a uniform number, summed over the pixels.
constexpr double gauge_variance = gauge_side * gauge_side / 12.0;

/// Fed with samples of which the part `spread` of the variance is antithetic from one sample of a
/// sequence to its next, and the rest independent.
SpreadGauge fed(double spread) {
  SpreadGauge gauge(gauge_side, gauge_side);
  const float smooth = float(std::sqrt(spread)), rough = float(std::sqrt(1 - spread));
  for (std::uint64_t i = 0; i < gauge_samples; ++i) {
    Image image(gauge_side, gauge_side);
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
      Rng pair(1 + i % 2, i / 4, p, Rng::Purpose::test), own(3, i, p, Rng::Purpose::test);
      const float sign = i / 2 % 2 == 0 ? 1.0F : -1.0F;
      const float v = smooth * sign * (pair.next() - 0.5F) + rough * (own.next() - 0.5F);
      image.pixels[p] = Rgb(v, v, v);
    }
    gauge.add(image);
  }
  return gauge;
}

TEST(SpreadGauge, TellsWhatIsLeftOfTheVariance) {
  // The mean of 4096 pixels has 2 % of deviation.
  const Spread none = *fed(0).spread(gauge_variance);
  EXPECT_GT(none.left, 0.93);
  EXPECT_EQ(none.count, gauge_samples);
  EXPECT_NEAR(none.left_of(1000), 1, 0.1);
  EXPECT_EQ(fed(1).spread(gauge_variance)->left, 1.0 / gauge_samples) << "the least that it tells";
  // Antithetic samples leave nothing.
  EXPECT_NEAR(fed(0.5).spread(gauge_variance)->left, 0.5, 0.05);
}

TEST(SpreadGauge, SaysNothingOfFewSamples) {
  SpreadGauge gauge(2, 2);
  for (int i = 0; i < 7; ++i) {
    gauge.add(Image(2, 2));
    EXPECT_FALSE(gauge.spread(1));
  }
  gauge.add(Image(2, 2));
  EXPECT_TRUE(gauge.spread(1));
  EXPECT_FALSE(gauge.spread(0));
}

TEST(SpreadGauge, WhatIsLeftGoesOnFalling) {
  const Spread s{.left = 0.25, .count = 16, .later = 0.5};
  EXPECT_EQ(s.left_of(1), 1);
  EXPECT_NEAR(s.left_of(4), 0.5, 1e-12);
  EXPECT_NEAR(s.left_of(16), 0.25, 1e-12);
  EXPECT_NEAR(s.left_of(1600), 0.025, 1e-12);
  EXPECT_EQ(Spread{}.left_of(1000), 1);
}

/// Of each sequence of spread samples the mean of n has the error of a deviation that falls as
/// n^-(1 + fall) / 2.
Spread after(std::uint64_t samples, double fall, double variance) {
  SpreadGauge gauge(gauge_side, gauge_side);
  std::array<Image, 2> sums{Image(gauge_side, gauge_side), Image(gauge_side, gauge_side)};
  for (std::uint64_t i = 0; i < samples; ++i) {
    const double n = double(i / 2 + 1);
    Image estimate(gauge_side, gauge_side);
    Image& sum = sums[i % 2];
    for (std::size_t p = 0; p < estimate.pixels.size(); ++p) {
      Rng rng(1 + i % 2, 0, p, Rng::Purpose::test);
      const float deviation = (rng.next() - 0.5F) * float(std::pow(n, (1 - fall) / 2));
      estimate.pixels[p] = Rgb(deviation) - sum.pixels[p];
      sum.pixels[p] = Rgb(deviation);
    }
    gauge.add(estimate);
  }
  return *gauge.spread(variance);
}

TEST(SpreadGauge, SeesHowFastTheErrorFalls) {
  for (const double fall : {0.0, 0.3, 0.8}) {
    // Half of the mean fall, which the first samples do not decide here, and the last slope.
    const Spread s = after(128, fall, gauge_variance);
    const double mean_fall = -std::log(s.left) / std::log(128.0);
    EXPECT_NEAR(s.later, (mean_fall / 2 + fall) / 2, 0.02) << fall;
  }
}

TEST(SpreadGauge, IsSaved) {
  const SpreadGauge gauge = fed(0.5);
  ByteWriter out;
  gauge.save(out);
  SpreadGauge loaded(gauge_side, gauge_side);
  ByteReader in(out.bytes());
  loaded.load(in);
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(loaded.count(), gauge.count());
  EXPECT_EQ(loaded.spread(gauge_variance)->left, gauge.spread(gauge_variance)->left);
  EXPECT_EQ(loaded.spread(gauge_variance)->later, gauge.spread(gauge_variance)->later);
  SpreadGauge other(gauge_side, 1);
  ByteReader again(out.bytes());
  EXPECT_THROW(other.load(again), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
