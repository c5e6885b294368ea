// Integrators against answers that are known exactly (jobs/scenes/README.md).

#include <gtest/gtest.h>

#include <numbers>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/same_picture.h"

namespace lacuna {
namespace {

using test::render;
using test::Rendering;

PathSettings path(int max_depth, bool nee = true) {
  PathSettings s;
  s.max_depth = max_depth;
  s.next_event_estimation = nee;
  return s;
}

/// The mean of the whole picture equals `expected`, within its own noise.
void expect_mean(const Rendering& r, double expected) {
  const double deviation = std::sqrt(r.variance_of_mean());
  // 4.5 deviations: one false alarm in 150,000 tests. Rounding in float adds a little.
  EXPECT_NEAR(r.mean(), expected, 4.5 * deviation + 2e-6 * expected);
  EXPECT_LT(deviation, 0.02 * expected) << "the test has no power";
  EXPECT_EQ(r.counters.rejected, 0U);
}

TEST(Furnace, EveryDepthAndStrategy) {
  for (const bool nee : {true, false}) {
    for (const int depth : {1, 2, 3, 6, 20}) {
      SCOPED_TRACE(testing::Message() << "depth " << depth << ", nee " << nee);
      const Rendering r =
          render("furnace.glb", {.integrator = path(depth, nee), .camera = "inside"});
      expect_mean(r, 2 - std::pow(2.0, 1 - depth));
    }
  }
}

// Light tracing and connections: pixels of one iteration share light paths, so the noise is that of
// whole iterations.
TEST(Furnace, EveryDepthFromTheLight) {
  for (const int depth : {1, 2, 3, 6, 15}) {
    std::vector<test::Method> methods = test::connections(depth);
    methods.push_back({"light", test::light_tracing(depth)});
    for (const test::Method& m : methods) {
      SCOPED_TRACE(testing::Message() << "depth " << depth << ", " << m);
      const Rendering r = render("furnace.glb", {.integrator = m.settings,
                                                 .width = 12,
                                                 .height = 10,
                                                 .iterations = m.name == "light" ? 500 : 50,
                                                 .camera = "inside"});
      const statistics::Moments mean = test::mean_over_iterations(r);
      const double expected = 2 - std::pow(2.0, 1 - depth);
      if (std::abs(mean.mean() - expected) > test::rounding * expected) {
        EXPECT_GT(statistics::t_test(mean, expected), 1e-7)
            << mean.mean() << ", expected " << expected;
      }
      EXPECT_LT(mean.standard_error(), 0.01 * expected) << "the test has no power";
      EXPECT_EQ(r.counters.rejected, 0U);
    }
  }
}

TEST(Furnace, SmoothSphereKeepsItsEnergy) {
  const Rendering r =
      render("furnace_sphere.glb", {.integrator = path(2), .iterations = 64, .camera = "close"});
  const std::vector<double> mean = r.film.mean();
  const std::vector<double> variance = r.film.variance_of_mean();
  // The middle of the picture shows the sphere alone: 0.8 (1 + cos d) / 2, d at most 0.1.
  double sum = 0;
  double sum_variance = 0;
  int n = 0;
  for (int y = 12; y < 20; ++y) {
    for (int x = 12; x < 20; ++x) {
      const auto i = static_cast<std::size_t>(3 * (y * 32 + x));
      sum += mean[i];
      sum_variance += variance[i];
      ++n;
    }
  }
  const double slack = 4.5 * std::sqrt(sum_variance) / n;
  EXPECT_GT(sum / n, 0.798 - slack);
  EXPECT_LT(sum / n, 0.800 + slack);
  EXPECT_LT(slack, 0.02);
}

/// Pixel centres' floor positions in the four light scenes.
V2f floor_position(int i, int j, int width) {
  const auto at = [&](int k) {
    return 1.5F * (2 * (static_cast<float>(k) + 0.5F) / static_cast<float>(width) - 1);
  };
  return {at(i), at(j)};
}

/// A z-test of each pixel against a smooth exact answer, but for pixels whose centre `hidden(x, z)`
/// from the camera. A pixel averages over its own area, so the answer is averaged as well.
template <class Exact, class Hidden>
void expect_picture(const Rendering& r, Exact&& exact, Hidden&& hidden) {
  const int n = r.film.width();
  const std::vector<double> mean = r.film.mean();
  const std::vector<double> variance = r.film.variance_of_mean();
  double chi2 = 0;
  int pixels = 0;
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      const V2f centre = floor_position(i, j, n);
      if (hidden(double(centre.x), double(centre.y))) continue;
      double expected = 0;
      constexpr int sub = 8;
      for (int k = 0; k < sub * sub; ++k) {
        const V2f p = floor_position(i * sub + k % sub, j * sub + k / sub, n * sub);
        expected += exact(double(p.x), double(p.y)) / (sub * sub);
      }
      const auto k = static_cast<std::size_t>(3 * (j * n + i));
      const double d = mean[k] - expected;
      const double floor = 1e-5 * (expected + 1e-6);  // rounding
      chi2 += d * d / (variance[k] + floor * floor);
      ++pixels;
    }
  }
  EXPECT_GT(pixels, n * n / 3);
  EXPECT_GT(chi_square_beyond(chi2, pixels), 1e-5) << "chi2 " << chi2 << " of " << pixels;
  EXPECT_EQ(r.counters.rejected, 0U);
}

constexpr auto nothing_hidden = [](double, double) { return false; };

constexpr double albedo_over_pi = 0.5 / std::numbers::pi;

TEST(Lights, Point) {
  const Rendering r =
      render("point.glb", {.width = 16, .height = 16, .iterations = 256, .camera = "above"});
  expect_picture(
      r,
      [](double x, double z) {
        const double r2 = x * x + z * z + 4;
        return albedo_over_pi * 10 * (2 / std::sqrt(r2)) / r2;
      },
      nothing_hidden);
}

TEST(Lights, Spot) {
  const Rendering r =
      render("spot.glb", {.width = 16, .height = 16, .iterations = 512, .camera = "above"});
  const auto radians = [](double degrees) { return degrees * std::numbers::pi / 180; };
  expect_picture(
      r,
      [&](double x, double z) {
        const double r2 = x * x + z * z + 4;
        const double cos = 2 / std::sqrt(r2);
        const double f = std::clamp(
            (cos - std::cos(radians(30))) / (std::cos(radians(20)) - std::cos(radians(30))), 0.0,
            1.0);
        return albedo_over_pi * 10 * cos / r2 * f * f;
      },
      nothing_hidden);
}

TEST(Lights, Directional) {
  const Rendering r =
      render("directional.glb", {.width = 8, .height = 8, .iterations = 2, .camera = "above"});
  for (const double v : r.film.mean()) {
    EXPECT_NEAR(v, albedo_over_pi * 3 * std::cos(std::numbers::pi / 6), 1e-6);
  }
}

/// Form factor of a parallel rectangle seen from a corner's foot; a, b: sides over height.
double corner_form_factor(double a, double b) {
  const double u = std::sqrt(1 + a * a);
  const double v = std::sqrt(1 + b * b);
  return (a / u * std::atan(b / u) + b / v * std::atan(a / v)) / (2 * std::numbers::pi);
}

TEST(Lights, Area) {
  const auto exact = [](double x, double z) {
    const auto quarter = [](double a, double b) {
      return std::copysign(1.0, a) * std::copysign(1.0, b) *
             corner_form_factor(std::abs(a) / 2, std::abs(b) / 2);
    };
    return 0.5 * 5 *
           (quarter(0.5 - x, 0.5 - z) + quarter(0.5 + x, 0.5 - z) + quarter(0.5 - x, 0.5 + z) +
            quarter(0.5 + x, 0.5 + z));
  };
  const Rendering r =
      render("area.glb", {.width = 16, .height = 16, .iterations = 256, .camera = "above"});
  // The quad itself hides the floor below it from the camera above.
  expect_picture(r, exact,
                 [](double x, double z) { return std::max(std::abs(x), std::abs(z)) < 1.1; });
}

TEST(Delta, EmitterSeenInAMirror) {
  const Rendering r =
      render("mirror.glb", {.width = 64, .height = 64, .iterations = 8, .camera = "front"});
  const std::vector<double> mean = r.film.mean();
  int exact = 0;
  for (std::size_t i = 0; i < mean.size(); i += 3) {
    if (mean[i] == 4 && mean[i + 1] == 3 && mean[i + 2] == 2) ++exact;
  }
  EXPECT_GT(exact, 50) << "no pixel shows the emitter with exactly its radiance";
  EXPECT_EQ(r.counters.rejected, 0U);
}

/// What `sides.glb` sends from the point (x, y, 0) to a camera that sees it through (grille_x, .,
/// 0.3) (jobs/scenes/README.md); nothing where an edge is too near to tell.
std::optional<Rgb> sides_answer(bool front, double x, double y, double grille_x) {
  constexpr double margin = 0.06;  // half a pixel's footprint and half a texel
  constexpr double bottom = 0.6;
  constexpr std::array<double, 5> left{-4, -2.2, -0.4, 1.4, 3.2};
  for (std::size_t i = 0; i < left.size(); ++i) {
    // The grille is wider than its quad, so the quad is never seen past it.
    const double u = x - left[i];
    const double v = y - bottom;
    if (u < -margin || u > 1 + margin || v < -margin || v > 1 + margin) continue;
    if (u < margin || u > 1 - margin || v < margin || v > 1 - margin) return std::nullopt;
    const bool shines = i == 2 || front == (i != 1);
    if (!shines) return Rgb(0, 0, 0);
    if (i == 3) {
      if (std::abs(u - 0.5) < margin || std::abs(v - 0.5) < margin) return std::nullopt;
      if (v > 0.5) return u < 0.5 ? Rgb(2, 0, 0) : Rgb(0, 2, 0);
      return u < 0.5 ? Rgb(0, 0, 2) : Rgb(2, 2, 2);
    }
    if (i == 4) {
      // Four bars and four gaps on a width of 1.4, a gap first.
      const double stripe = (grille_x - (left[i] - 0.2)) / (1.4 / 8);
      if (std::abs(stripe - std::round(stripe)) * (1.4 / 8) < margin / 2) return std::nullopt;
      if (static_cast<int>(stripe) % 2 == 1) return Rgb(0, 0, 0);
    }
    return Rgb(2, 2, 2);
  }
  return Rgb(0, 0, 0);
}

TEST(Emission, SidesAndMasks) {
  constexpr int width = 256;
  constexpr int height = 128;
  const SceneData data = load_gltf(test::own_scene("sides.glb"));
  for (const std::string name : {"front", "back"}) {
    const Rendering r = render(
        "sides.glb",
        {.integrator = path(1), .width = width, .height = height, .iterations = 1, .camera = name});
    const Camera camera(choose_camera(data, name, "sides.glb"), width, height);
    const std::vector<double> seen = r.film.mean();
    std::array<int, 3> tested{};  // black, white, coloured
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const Ray ray = camera.ray(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
        const V3d o(ray.o);
        const V3d d(ray.d);
        const V3d at = o - d * (o.z / d.z);
        const double grille_x = (o + d * ((0.3 - o.z) / d.z)).x;
        const auto answer = sides_answer(name == "front", at.x, at.y, grille_x);
        if (!answer) continue;
        const auto i = static_cast<std::size_t>(3 * (y * width + x));
        EXPECT_EQ(Rgb(V3d(seen[i], seen[i + 1], seen[i + 2])), *answer)
            << name << ", pixel " << x << ", " << y << ", x " << at.x << ", y " << at.y;
        const bool grey = answer->x == answer->y && answer->y == answer->z;
        ++tested[is_black(*answer) ? 0 : grey ? 1 : 2];
      }
    }
    EXPECT_GT(tested[0], 10000) << name;
    EXPECT_GT(tested[1], 500) << name;
    EXPECT_EQ(tested[2] > 200, name == "front") << name;
  }
}

}  // namespace
}  // namespace lacuna
