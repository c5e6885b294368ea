#include "renderer/race/spread_gauge.h"

#include <gtest/gtest.h>

#include "analysis/storage/bytes.h"
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

TEST(SpreadGauge, TellsWhichPartOfTheVarianceIsNotSpread) {
  // The mean of 4096 pixels has 2 % of deviation.
  EXPECT_GT(*fed(0).rough_part(gauge_variance), 0.93);
  EXPECT_EQ(*fed(1).rough_part(gauge_variance), 0);
  // Antithetic samples leave nothing, not the 1 / n of the model.
  const double model = (0.5 - 2.0 / gauge_samples) / (1 - 2.0 / gauge_samples);
  EXPECT_NEAR(*fed(0.5).rough_part(gauge_variance), model, 0.05);
}

TEST(SpreadGauge, SaysNothingOfFewSamples) {
  SpreadGauge gauge(2, 2);
  for (int i = 0; i < 7; ++i) {
    gauge.add(Image(2, 2));
    EXPECT_FALSE(gauge.rough_part(1));
  }
  gauge.add(Image(2, 2));
  EXPECT_TRUE(gauge.rough_part(1));
  EXPECT_FALSE(gauge.rough_part(0));
}

TEST(SpreadGauge, WhatIsLeftFallsToTheRoughPart) {
  EXPECT_EQ(SpreadGauge::left_of(1, 1000), 1);
  EXPECT_EQ(SpreadGauge::left_of(0.25, 1), 1);
  EXPECT_NEAR(SpreadGauge::left_of(0.25, 1e9), 0.25, 1e-6);
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
  EXPECT_EQ(loaded.rough_part(gauge_variance), gauge.rough_part(gauge_variance));
  SpreadGauge other(gauge_side, 1);
  ByteReader again(out.bytes());
  EXPECT_THROW(other.load(again), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
