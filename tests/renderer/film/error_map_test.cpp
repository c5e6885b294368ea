#include "renderer/film/error_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderer/core/rng.h"
#include "renderer/film/metrics.h"

namespace lacuna {
namespace {

TEST(ErrorMap, HasTheErrorOfThePictureAsItsMean) {
  constexpr int w = 30, h = 20;
  std::vector<double> a, b;
  Rng rng(1, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 3 * w * h; ++i) {
    a.push_back(double(rng.next()));
    b.push_back(double(rng.next()));
  }
  const Errors whole = errors(a, b);
  for (const ErrorMetricRow& metric : error_metrics) {
    if (metric.term == nullptr) continue;
    double sum = 0;
    for (const float v : error_map(metric.value, {a, b, w, h})) {
      sum += metric.root ? double{v} * double{v} : double{v};
    }
    const double mean = sum / (w * h);
    EXPECT_NEAR(metric.root ? std::sqrt(mean) : mean, whole[metric.value], 1e-6) << metric.name;
  }
  const auto flip = error_map(ErrorMetric::flip, {a, b, w, h});
  EXPECT_EQ(flip, hdr_flip({a, b, w, h}, flip_exposures(b)));
  EXPECT_EQ(largest_shown_error(ErrorMetric::flip, flip), 1);
  EXPECT_THROW(error_map(ErrorMetric::est_rmse, {a, b, w, h}), std::invalid_argument);
  EXPECT_THROW(error_map(ErrorMetric::mse, {a, b, w, h + 1}), std::invalid_argument);
}

TEST(ErrorMap, ShowsAllButTheLargestHundredth) {
  std::vector<float> map;
  for (int i = 1; i <= 1000; ++i) map.push_back(float(i));
  map.push_back(std::nanf(""));
  EXPECT_EQ(largest_shown_error(ErrorMetric::mse, map), 990);
  EXPECT_EQ(largest_shown_error(ErrorMetric::mse, std::vector<float>(7, 0.0F)), 1);
}

TEST(ErrorMap, ColoursGoFromBlackToYellowAndGetBrighter) {
  EXPECT_EQ(magma(-1), magma(0));
  EXPECT_EQ(magma(0), (std::array<std::uint8_t, 3>{0, 0, 4}));
  EXPECT_EQ(magma(1), (std::array<std::uint8_t, 3>{252, 253, 191}));
  EXPECT_EQ(magma(std::nan("")), magma(1));
  double before = -1;
  for (int i = 0; i <= 100; ++i) {
    const auto c = magma(i / 100.0);
    const double luma = 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
    EXPECT_GT(luma, before) << i;
    before = luma;
  }
  EXPECT_EQ(magma_codes(std::vector<float>{0, 2}, 2).size(), 6U);
}

}  // namespace
}  // namespace lacuna
