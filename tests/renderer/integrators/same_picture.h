#pragma once

#include <gtest/gtest.h>

#include "tests/renderer/integrators/render.h"
#include "tests/statistics.h"

namespace lacuna::test {

// Are two pictures estimates of one? z-tests over iterations, with the noise of both, so that it
// does not matter what pixels of one iteration have in common.

/// Methods, blocks and channels of all scenes: the tests that are made.
inline constexpr std::size_t all_tests = 10000;
/// What rounding in float makes of a mean, at most, where all else is equal.
inline constexpr double rounding = 2e-5;

/// How sure it is that two quantities, each a mean over iterations, differ by more than rounding.
inline double same_p(const statistics::Moments& a, const statistics::Moments& b) {
  if (std::abs(a.mean() - b.mean()) <= rounding * std::abs(b.mean())) return 1;
  return statistics::t_test(a, b);
}

inline statistics::Moments over_iterations(const Rendering& r, std::size_t value) {
  statistics::Moments m;
  for (const auto& values : r.blocks) m.add(values[value]);
  return m;
}
inline statistics::Moments mean_over_iterations(const Rendering& r) {
  statistics::Moments m;
  for (const auto& values : r.blocks) {
    double sum = 0;
    for (const double v : values) sum += v;
    m.add(sum / static_cast<double>(values.size()));
  }
  return m;
}

/// `useful`: the largest standard error of the difference of means, relative, that is still a test.
/// `negative`: pixels may be.
inline void expect_same_picture(const Rendering& a, const Rendering& b, double useful,
                                bool negative = false) {
  const double level = statistics::sidak(1e-5, all_tests);
  const statistics::Moments x = mean_over_iterations(a), y = mean_over_iterations(b);
  EXPECT_GT(same_p(x, y), level) << "mean " << x.mean() << " +- " << x.standard_error() << ", not "
                                 << y.mean() << " +- " << y.standard_error();
  EXPECT_LE(std::hypot(x.standard_error(), y.standard_error()), useful * y.mean())
      << "the test has no power";
  double least = 1;
  std::size_t where = 0;
  for (std::size_t i = 0; i < a.blocks[0].size(); ++i) {
    const double p = same_p(over_iterations(a, i), over_iterations(b, i));
    if (p < least) least = p, where = i;
  }
  EXPECT_GT(least, level) << "block " << where / 3 << ", channel " << where % 3 << ": "
                          << over_iterations(a, where).mean() << ", not "
                          << over_iterations(b, where).mean();
  EXPECT_EQ(a.counters.rejected, 0U);
  if (!negative) {
    EXPECT_EQ(a.counters.negative, 0U);
  }
}

}  // namespace lacuna::test
