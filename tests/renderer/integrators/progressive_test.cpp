// What a schedule of radii does: the error falls as it predicts, and no radius breaks a picture.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"
#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::Rendering;
using test::RenderSettings;

/// The middle of a wide floor below a lamp: all light in view is smooth, and no disc reaches over
/// an edge, so that the bias is quadratic in the radius.
SceneData floor_below_lamp() {
  test::SceneParts p;
  p.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, p.material(test::diffuse(Rgb(0.8F))));
  p.quad({-0.25F, 1, -0.25F}, {0.5F, 0, 0}, {0, 0, 0.5F}, p.material(test::lamp(Rgb(5, 5, 5))));
  p.eye({0.4, 0.7, 0.5}, {0.3, 0, 0.2}, 0.6);
  return std::move(p.data);
}

/// Least-squares slope of log `y` over log `x`.
double slope(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto n = static_cast<double>(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(y[i]);
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/// Variance of the mean of n iterations, of which i has 1 / r_i^2 = i^(1 - alpha).
double predicted_variance(double n, double alpha) {
  double sum = 0;
  for (int i = 1; i <= n; ++i) sum += std::pow(i, 1 - alpha);
  return sum / (n * n);
}

const std::vector<double> numbers_of_iterations{16, 32, 64, 128, 256, 512, 1024};

/// The error after so many iterations, of one seed.
std::vector<double> errors_of(const SppmSettings& settings, std::uint64_t seed,
                              const std::vector<double>& reference) {
  test::Session session(floor_below_lamp(),
                        {.integrator = settings, .width = 12, .height = 8, .seed = seed});
  std::vector<double> sum(reference.size(), 0.0), errors;
  for (std::uint64_t i = 0; static_cast<double>(i) < numbers_of_iterations.back(); ++i) {
    const Image image = session.iterate(i);
    for (std::size_t p = 0; p < image.pixels.size(); ++p) {
      for (int c = 0; c < 3; ++c) {
        sum[3 * p + static_cast<std::size_t>(c)] += double(image.pixels[p][c]);
      }
    }
    const auto n = static_cast<double>(i + 1);
    if (n != numbers_of_iterations[errors.size()]) continue;
    double mse = 0;
    for (std::size_t k = 0; k < sum.size(); ++k) {
      mse += (sum[k] / n - reference[k]) * (sum[k] / n - reference[k]);
    }
    errors.push_back(mse / static_cast<double>(sum.size()));
  }
  return errors;
}

TEST(LongSppm, ErrorFallsAtTheRateOfItsSchedule) {
  const RenderSettings precise{.integrator = test::path_tracing(2),
                               .width = 12,
                               .height = 8,
                               .iterations = 20000,
                               .seed = 9};
  const std::vector<double> reference = test::render(floor_below_lamp(), precise).film.mean();
  for (const double alpha : {0.4, 2.0 / 3, 0.9}) {
    SppmSettings settings = test::of_length(SppmSettings{}, 2);
    settings.next_event_estimation = false;  // whose noise falls as 1 / n
    settings.light_paths = 200;
    settings.radius = 0.08;
    settings.radius_unit = RadiusUnit::absolute;
    settings.alpha = alpha;
    Moments slopes;
    for (std::uint64_t seed = 1; seed <= 16; ++seed) {
      slopes.add(slope(numbers_of_iterations, errors_of(settings, seed, reference)));
    }
    std::vector<double> predicted;
    predicted.reserve(numbers_of_iterations.size());
    for (const double n : numbers_of_iterations) predicted.push_back(predicted_variance(n, alpha));
    EXPECT_GT(statistics::t_test(slopes, slope(numbers_of_iterations, predicted)), 1e-4)
        << "alpha " << alpha << ": slope " << slopes.mean() << " +- " << slopes.standard_error()
        << ", not " << slope(numbers_of_iterations, predicted);
    EXPECT_LT(slopes.standard_error(), 0.05) << "the test has no power";
  }
}

// Below what floats tell apart, hardly a vertex is merged; the rest must be right.
TEST(Radius, BelowTheGrainOfFloatsLeavesThePictureAlone) {
  for (const double radius : {1e-300, 1e-9}) {
    const IntegratorSettings vcm =
        test::fixed_radius(test::of_length(VcmSettings{}, 4), radius, RadiusUnit::absolute);
    const Rendering merged = test::render(
        "cornell.glb", {.integrator = vcm, .width = 20, .height = 12, .iterations = 200});
    const Rendering expected = test::render("cornell.glb", {.integrator = test::path_tracing(4),
                                                            .width = 20,
                                                            .height = 12,
                                                            .iterations = 800,
                                                            .seed = 2});
    test::expect_same_picture(merged, expected, 0.02);
  }
}

// As large as a radius may be: far too blurred, but finite, positive and not slow.
TEST(LongRadius, BeyondTheSceneIsABlur) {
  for (const test::Method& method : test::merging(4)) {
    SCOPED_TRACE(method);
    for (const double radius : {1e3, 1e15}) {
      const Rendering r = test::render(
          "cornell.glb",
          {.integrator = test::fixed_radius(method.settings, radius, RadiusUnit::absolute),
           .width = 40,
           .height = 30,
           .iterations = 2});
      EXPECT_EQ(r.counters.rejected + r.counters.negative, 0U);
      EXPECT_TRUE(std::isfinite(r.mean()));
    }
  }
}

// k photons in the disc up to the next one: for a uniform density that is its mean, for each
// kernel.
TEST(Photons, TheNearestGiveTheDensityOfAll) {
  PhotonMapSettings photons = test::of_length(PhotonMapSettings{}, 2);
  photons.next_event_estimation = false;
  photons.light_paths = 2000;
  photons.nearest = 8;
  const auto picture = [](const IntegratorSettings& s, int n) {
    return test::mean_over_iterations(test::render(
        floor_below_lamp(), {.integrator = s, .width = 12, .height = 8, .iterations = n}));
  };
  const Moments expected = picture(test::path_tracing(2), 400);
  for (const PhotonKernel kernel : {PhotonKernel::constant, PhotonKernel::cone}) {
    photons.kernel = kernel;
    const Moments found = picture(test::fixed_radius(photons, 0.5, RadiusUnit::absolute), 80);
    EXPECT_GT(test::same_p(found, expected), 1e-4)
        << found.mean() << " +- " << found.standard_error() << ", not " << expected.mean();
    EXPECT_LT(std::hypot(found.standard_error(), expected.standard_error()), 0.02 * expected.mean())
        << "the test has no power";
  }
}

/// A spot from above, seen from above: the disc of radius 0.4 that it lights is two fifths of the
/// picture's width.
SceneData round_spot() {
  test::SceneParts p;
  p.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, p.material(test::diffuse(Rgb(0.8F))));
  p.light(PunctualLight::Kind::spot, {0, 1, 0}, {0, -1, 0}, Rgb(1, 1, 1));
  p.data.lights.back().outer_cone = p.data.lights.back().inner_cone = std::atan(0.4F);
  p.eye({0, 2, 0.01}, {0, 0, 0}, 2 * std::atan(0.5));
  return std::move(p.data);
}

// Also where there are more than a look-up of all within the radius visits.
TEST(Photons, TheNearestOfManyAreNear) {
  PhotonMapSettings photons = test::of_length(PhotonMapSettings{}, 2);
  photons.next_event_estimation = false;
  photons.light_paths = 100'000;  // 25 times what a look-up visits
  photons.nearest = 100;          // within 0.013 of a point
  constexpr int width = 40;
  const Rendering r = test::render(
      round_spot(), {.integrator = test::fixed_radius(photons, 1, RadiusUnit::absolute),
                     .width = width,
                     .height = width,
                     .iterations = 4});
  const std::vector<double> values = r.film.mean();
  double outside = 0, all = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto pixel = static_cast<int>(k / 3);
    const double x = pixel % width + 0.5 - 0.5 * width, y = pixel / width + 0.5 - 0.5 * width;
    all += values[k];
    if (std::hypot(x, y) > 0.25 * width) outside += values[k];
  }
  EXPECT_GT(all, 0);
  EXPECT_LT(outside, 0.01 * all);
}

// The estimate k / (pi r_{k+1}^2) of a uniform density has the relative variance 1 / (k - 1), also
// where there are more photons than a look-up of all within the radius visits.
TEST(Photons, TheNearestOfManyHaveTheNoiseOfTheirNumber) {
  PhotonMapSettings photons = test::of_length(PhotonMapSettings{}, 2);
  photons.next_event_estimation = false;
  photons.kernel = PhotonKernel::constant;
  photons.light_paths = 100'000;
  photons.nearest = 8;
  constexpr int width = 40;
  statistics::Moments values;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const std::vector<double> mean =
        test::render(round_spot(),
                     {.integrator = test::fixed_radius(photons, 1, RadiusUnit::absolute),
                      .width = width,
                      .height = width,
                      .iterations = 1,
                      .seed = seed})
            .film.mean();
    for (std::size_t k = 0; k < mean.size(); k += 3) {
      const auto pixel = static_cast<int>(k / 3);
      const double x = pixel % width + 0.5 - 0.5 * width, y = pixel / width + 0.5 - 0.5 * width;
      if (std::hypot(x, y) < 0.15 * width) values.add(mean[k]);
    }
  }
  EXPECT_NEAR(values.variance() / (values.mean() * values.mean()), 1 / 7.0, 0.05);
}

/// The lamp shines upwards, away from all else.
SceneData turned_away() {
  test::SceneParts p;
  p.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, p.material(test::diffuse(Rgb(0.8F))));
  p.quad({-1, 1, 1}, {2, 0, 0}, {0, 0, -2}, p.material(test::lamp(Rgb(5, 5, 5))));
  p.eye({0, 0.5, 3}, {0, 0, 0}, 0.6);
  return std::move(p.data);
}

TEST(Photons, ThatHitNothingAreNone) {
  for (const test::Method& method : test::merging(4)) {
    SCOPED_TRACE(method);
    const Rendering r = test::render(
        turned_away(), {.integrator = method.settings, .width = 10, .height = 8, .iterations = 2});
    EXPECT_EQ(r.mean(), 0);
    EXPECT_EQ(r.counters.rejected, 0U);
  }
}

/// All light within a narrow cone: every photon is at one place, which the camera looks at.
SceneData bright_spot() {
  test::SceneParts p;
  p.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, p.material(test::diffuse(Rgb(0.8F))));
  p.light(PunctualLight::Kind::spot, {0, 1, 0}, {0, -1, 0}, Rgb(100, 100, 100));
  p.data.lights.back().outer_cone = 0.005F;
  p.data.lights.back().inner_cone = 0;
  p.eye({0, 1, 0.01}, {0, 0, 0}, 0.2);
  return std::move(p.data);
}

// What a look-up visits is bounded, and the light is all there.
TEST(Photons, AtOnePointKeepTheirLight) {
  SppmSettings photons = test::of_length(SppmSettings{}, 2);
  photons.next_event_estimation = false;
  photons.light_paths = 20000;  // more than a look-up takes
  const auto settings = [](const IntegratorSettings& s, int n) {
    return RenderSettings{.integrator = s, .width = 24, .height = 24, .iterations = n};
  };
  const Rendering r = test::render(
      bright_spot(), settings(test::fixed_radius(photons, 0.02, RadiusUnit::absolute), 60));
  const Rendering expected = test::render(bright_spot(), settings(test::path_tracing(2), 4000));
  // The disc spreads the light, and loses none of it.
  const Moments found = test::mean_over_iterations(r), all = test::mean_over_iterations(expected);
  EXPECT_NEAR(found.mean(), all.mean(),
              5 * std::hypot(found.standard_error(), all.standard_error()));
  EXPECT_LT(std::hypot(found.standard_error(), all.standard_error()), 0.03 * all.mean());
  EXPECT_GT(all.mean(), 0);
}

}  // namespace
}  // namespace lacuna
