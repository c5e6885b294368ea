// slab.glb: a floor that lamp and camera see through glass only, against its exact radiance.

#include <gtest/gtest.h>

#include <numbers>

#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"

namespace lacuna {
namespace {

using statistics::Moments;
using test::Method;
using test::Rendering;

// As jobs/scenes/trials.py has them; metres.
constexpr double thickness = 0.2, ior = 1.5, lamp_height = 2, lamp_side = 0.04, radiance = 20000,
                 albedo = 0.5;
constexpr int film_side = 24;

double in_glass(double a) { return std::asin(std::sin(a) / ior); }
/// Of unpolarised light that arrives at the angle `a` (Fresnel).
double transmitted_twice(double a) {
  const double b = in_glass(a), ca = std::cos(a), cb = std::cos(b);
  const double s = (ca - ior * cb) / (ca + ior * cb), p = (ior * ca - cb) / (ior * ca + cb);
  const double t = 1 - (s * s + p * p) / 2;
  return t * t;
}
/// How far a ray at the angle `a` to the vertical moves sideways from so high above the floor.
double sideways(double height, double a) {
  return (height - thickness) * std::tan(a) + thickness * std::tan(in_glass(a));
}

/// Of a point of the lamp that is `r` > 0 away sideways, times the lamp's area: flux over area, by
/// what leaves between two angles and the ring that it falls on.
double irradiance(double r) {
  double low = 0, high = std::numbers::pi / 2;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (sideways(lamp_height, middle) < r ? low : high) = middle;
  }
  const double a = low, b = in_glass(a);
  const double widening = (lamp_height - thickness) / (std::cos(a) * std::cos(a)) +
                          thickness * std::cos(a) / (ior * std::pow(std::cos(b), 3));
  return radiance * lamp_side * lamp_side * std::cos(a) * transmitted_twice(a) * std::sin(a) /
         (r * widening);
}

/// What arrives at the eye along unit `w`.
double seen_along(const V3f& eye, const V3f& w) {
  const double a = std::acos(-double(w.y));
  const double moved = sideways(double(eye.y), a) / std::sin(a);
  const double x = double(eye.x) + moved * double(w.x), z = double(eye.z) + moved * double(w.z);
  constexpr int steps = 4;
  double sum = 0;
  for (int i = 0; i < steps * steps; ++i) {
    const auto at = [](int k) { return lamp_side * ((k + 0.5) / steps - 0.5); };
    sum += irradiance(std::hypot(x - at(i % steps), z - at(i / steps)));
  }
  return albedo / std::numbers::pi * sum / (steps * steps) * transmitted_twice(a);
}

Image exact_picture(const Camera& camera) {
  constexpr int steps = 4;
  Image image(film_side, film_side);
  for (int y = 0; y < film_side; ++y) {
    for (int x = 0; x < film_side; ++x) {
      double sum = 0;
      for (int i = 0; i < steps * steps; ++i) {
        const auto at = [](int pixel, int k) {
          return static_cast<float>(pixel + (k + 0.5) / steps);
        };
        const Ray ray = camera.ray(at(x, i % steps), at(y, i / steps));
        sum += seen_along(ray.o, ray.d);
      }
      image.at(x, y) = Rgb(static_cast<float>(sum / (steps * steps)));
    }
  }
  return image;
}

Rendering rendering(const IntegratorSettings& integrator, int iterations) {
  return test::render("slab.glb", {.integrator = integrator,
                                   .width = film_side,
                                   .height = film_side,
                                   .iterations = iterations});
}

TEST(LongCaustics, ThroughGlassAreExact) {
  const SceneData scene = load_gltf(test::own_scene("slab.glb"));
  const std::vector<double> expected =
      block_means(exact_picture(Camera(scene.cameras.front(), film_side, film_side)));
  const double level = statistics::sidak(1e-5, test::all_tests);
  for (Method method : test::merging(6)) {
    SCOPED_TRACE(method);
    std::visit(
        [](auto& s) {
          if constexpr (requires { s.radius_unit; }) {
            s.radius = 0.04;  // the light is smooth: its bias is far below the noise
            s.radius_unit = RadiusUnit::absolute;
            s.alpha = 1;
          }
          if constexpr (requires { s.light_paths; }) s.light_paths = 5000;
        },
        method.settings);
    const Rendering r = rendering(method.settings, 120);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const Moments block = over_iterations(r, i);
      EXPECT_GT(statistics::t_test(block, expected[i]), level)
          << "block " << i / 3 << ": " << block.mean() << " +- " << block.standard_error()
          << ", not " << expected[i];
    }
    const Moments mean = mean_over_iterations(r);
    EXPECT_LT(mean.standard_error(), 0.05 * mean.mean()) << "the test has no power";
  }
}

// Chance alone finds the lamp.
TEST(Caustics, ThroughGlassAreNotFoundByJoining) {
  VcmSettings vcm = test::of_length(VcmSettings{}, 6);
  const auto noise = [](const Rendering& r) {
    double sum = 0;
    for (const double v : r.film.variance_of_mean()) sum += v;
    return sum;
  };
  const double merged = noise(rendering(vcm, 100));
  vcm.merge = false;
  EXPECT_GT(noise(rendering(vcm, 100)), 20 * merged);
}

}  // namespace
}  // namespace lacuna
