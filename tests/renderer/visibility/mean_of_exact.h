#pragma once

#include "renderer/visibility/plain_visibility.h"
#include "tests/renderer/many_lights/lit_scene.h"
#include "tests/statistics.h"

namespace lacuna::test {

/// `visibility` has the mean of exact visibility at every point, and sends fewer rays.
template <class Visibility>
void expect_mean_of_exact(const LitScene& lit, const Visibility& visibility,
                          std::span<const ShadingPoint> points, bool saves, int rounds = 400) {
  std::uint64_t all = 0;  // tests of exact visibility
  const ExactVisibility exact{{}};
  const auto expected = gathered(lit, lit.context(1), exact, points, &all);
  std::vector<statistics::Moments> means(points.size());
  statistics::Moments share;  // of these that a round takes
  for (int r = 0; r < rounds; ++r) {
    const IterationContext context = lit.context(static_cast<std::uint64_t>(r) + 2);
    std::uint64_t tests = 0;
    const auto values = gathered(lit, context, visibility, points, &tests);
    share.add(double(tests) / double(all));
    for (std::size_t i = 0; i < values.size(); ++i) means[i].add(values[i]);
  }
  const double level = statistics::sidak(1e-5, 5000);
  const double brightest = *std::max_element(expected.begin(), expected.end());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double se = means[i].standard_error();
    if (std::abs(means[i].mean() - expected[i]) <= 2e-5 * expected[i]) continue;
    EXPECT_GT(statistics::t_test(means[i], expected[i]), level)
        << "point " << i << ": " << means[i].mean() << " +- " << se << ", not " << expected[i];
    EXPECT_LT(se, 0.05 * brightest) << "the test has no power";
  }
  if (saves) {
    EXPECT_LT(statistics::t_test_at_least(share, 0.7), 1e-4)
        << share.mean() << " +- " << share.standard_error();
  }
}

}  // namespace lacuna::test
