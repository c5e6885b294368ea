#pragma once

#include "renderer/many_lights/vpl_sampler.h"
#include "renderer/visibility/plain_visibility.h"
#include "renderer/visibility/visibility.h"
#include "tests/renderer/many_lights/lit_scene.h"
#include "tests/statistics.h"

namespace lacuna::test {

/// Tests that the sums of sampled lights have the mean of the sum of all, at some shading points.
/// `V`: exact visibility.
template <Visibility V = ExactVisibility>
void expect_means_of_all(const LitScene& lit, const GatheredLights& sampled) {
  lit.with_points(400, [&](std::span<const ShadingPoint> points) {
    const V exact{{}};
    const auto expected = gathered(lit, lit.context(1), exact, points);
    std::vector<statistics::Moments> means(points.size());
    for (std::uint64_t r = 0; r < 600; ++r) {
      const auto values = gathered(lit, lit.context(r + 2), exact, points, nullptr, sampled);
      for (std::size_t i = 0; i < values.size(); ++i) means[i].add(values[i]);
    }
    const double level = statistics::sidak(1e-5, 6 * points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::abs(means[i].mean() - expected[i]) <= 1e-6 * expected[i]) continue;
      EXPECT_GT(statistics::t_test(means[i], expected[i]), level)
          << "point " << i << ": " << means[i].mean() << ", not " << expected[i];
    }
  });
}

/// The same of `random`. `cubes`: as of VplSampler.
inline void expect_means_of_all(const LitScene& lit, const RandomLightsSettings& settings,
                                const CubeCulling* cubes = nullptr) {
  VplSampler sampler(lit.terms(), settings, cubes);
  expect_means_of_all(lit, {&sampler});
}

}  // namespace lacuna::test
