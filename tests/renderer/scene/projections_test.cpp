// Cameras that are no pinholes: rays, film positions and densities agree.

#include <gtest/gtest.h>

#include <numbers>

#include "renderer/scene/camera.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

constexpr int film_width = 8, film_height = 6;

CameraData looking(Projection projection) {
  CameraData data;
  data.projection = projection;
  data.to_world.setTranslation(V3d(1, 2, 3));
  data.yfov = 1.2;
  data.height = 3;
  return data;
}
CameraData with_lens(int blades) {
  CameraData data = looking(Projection::perspective);
  data.aperture = 0.25;
  data.focus = 2;
  data.blades = blades;
  return data;
}
std::vector<CameraData> all_kinds() {
  return {looking(Projection::perspective), with_lens(0), with_lens(5),
          looking(Projection::orthographic), looking(Projection::panorama)};
}

TEST(Projections, RaysComeBackToTheirPlaceOnTheFilm) {
  for (const CameraData& data : all_kinds()) {
    const Camera camera(data, film_width, film_height);
    Rng rng(1, 0, 0, Rng::Purpose::test);
    for (int i = 0; i < 1000; ++i) {
      const V2i pixel(static_cast<int>(rng.below(film_width)),
                      static_cast<int>(rng.below(film_height)));
      const Ray ray = camera.sample(pixel, rng.next2(), rng);
      EXPECT_NEAR(ray.d.length(), 1, 1e-5);
      const auto at = camera.project(ray.o, ray.d);
      ASSERT_TRUE(at);
      EXPECT_GE(at->x, static_cast<float>(pixel.x) - 1e-3F);
      EXPECT_LE(at->x, static_cast<float>(pixel.x) + 1.001F);
      EXPECT_GE(at->y, static_cast<float>(pixel.y) - 1e-3F);
      EXPECT_LE(at->y, static_cast<float>(pixel.y) + 1.001F);
    }
  }
}

// What the eye of a light path sees is what a ray to it has.
TEST(Projections, APointIsSeenWhereARayHitsIt) {
  for (const CameraData& data : all_kinds()) {
    const Camera camera(data, film_width, film_height);
    Rng rng(2, 0, 0, Rng::Purpose::test);
    for (int i = 0; i < 200; ++i) {
      const V2f at = V2f(rng.next() * film_width, rng.next() * film_height);
      const V3f x = camera.ray(at.x, at.y).o + camera.ray(at.x, at.y).d * (1 + rng.next());
      const V3f eye = camera.eye(x, camera.lens_numbers(rng));
      const V3f w = (x - eye).normalized();
      const auto seen = camera.project(eye, w);
      if (!seen) continue;  // beyond the edge, from there
      const Ray ray = camera.ray(seen->x, seen->y, eye);
      EXPECT_LT((ray.o - eye).length(), 1e-5F);
      EXPECT_LT((ray.d - w).length(), 1e-5F);
    }
  }
}

TEST(Projections, TheDensityCountsPixels) {
  for (const CameraData& data : all_kinds()) {
    const Camera camera(data, film_width, film_height);
    Rng rng(3, 0, 0, Rng::Purpose::test);
    statistics::Moments m;
    for (int i = 0; i < 100000; ++i) {
      // Of directions from one point of the eye; of a parallel projection, of places on its plane.
      const V3f eye = camera.eye(camera.position(), camera.lens_numbers(rng));
      if (camera.parallel()) {
        const V3f at = eye + V3f(8 * rng.next() - 4, 8 * rng.next() - 4, 0);
        const bool seen = camera.project(at, camera.forward()).has_value();
        m.add(seen ? double(camera.density(camera.forward()).value) * 64 : 0);
        continue;
      }
      const float z = 1 - 2 * rng.next(), phi = 2 * std::numbers::pi_v<float> * rng.next();
      const float s = std::sqrt(1 - z * z);
      const V3f w(s * std::cos(phi), s * std::sin(phi), z);
      const bool seen = camera.project(eye, w).has_value();
      m.add(seen ? double(camera.density(w).value) * 4 * std::numbers::pi : 0);
    }
    EXPECT_GT(statistics::t_test(m, film_width * film_height), 1e-6)
        << m.mean() << " +- " << m.standard_error();
  }
}

TEST(Projections, ALensIsSharpAtItsFocusOnly) {
  const Camera camera(with_lens(0), film_width, film_height);
  Rng rng(4, 0, 0, Rng::Purpose::test);
  const Ray centre = camera.ray(2, 4);
  const auto spread = [&](float depth) {  // of rays through one place on the film
    double largest = 0;
    for (int i = 0; i < 100; ++i) {
      const Ray ray = camera.ray(2, 4, camera.eye(V3f(0), camera.lens_numbers(rng)));
      const auto at = [&](const Ray& r) { return r.o + r.d * (depth / -r.d.z); };
      largest = std::max(largest, double((at(ray) - at(centre)).length()));
    }
    return largest;
  };
  EXPECT_LT(spread(2), 1e-5);
  EXPECT_NEAR(spread(1), 0.125, 0.01);
  EXPECT_NEAR(spread(4), 0.25, 0.02);
}

// Chi-square over cells of polar coordinates of equal area: a polygon fills its own sector alike.
TEST(Projections, PointsOfTheLensAreUniform) {
  for (const int blades : {0, 3, 6}) {
    const CameraData data = with_lens(blades);
    const Camera camera(data, film_width, film_height);
    Rng rng(5, 0, 0, Rng::Purpose::test);
    constexpr int cells = 20, draws = 100000;
    std::vector<double> observed(cells * cells), expected(cells * cells);
    double inside = 0;
    const auto contains = [&](double x, double y) {
      if (blades == 0) return x * x + y * y < 1;
      for (int k = 0; k < blades; ++k) {
        const double middle = std::numbers::pi / 2 + std::numbers::pi * (2 * k + 1) / blades;
        if (x * std::cos(middle) + y * std::sin(middle) > std::cos(std::numbers::pi / blades)) {
          return false;
        }
      }
      return true;
    };
    constexpr int fine = 40;  // points a side of a cell, for its share
    for (int j = 0; j < cells * fine; ++j) {
      for (int i = 0; i < cells * fine; ++i) {
        const double x = 2 * (i + 0.5) / (cells * fine) - 1, y = 2 * (j + 0.5) / (cells * fine) - 1;
        if (!contains(x, y)) continue;
        ++expected[static_cast<std::size_t>(j / fine * cells + i / fine)];
        ++inside;
      }
    }
    for (double& e : expected) e *= draws / inside;
    for (int i = 0; i < draws; ++i) {
      const V3f p = (camera.eye(V3f(0), camera.lens_numbers(rng)) - camera.position()) / 0.25F;
      const auto cell = [](float x) {
        return std::clamp(static_cast<int>((x + 1) / 2 * cells), 0, cells - 1);
      };
      ++observed[static_cast<std::size_t>(cell(p.y) * cells + cell(p.x))];
    }
    EXPECT_GT(statistics::chi_square_test(observed, expected).p, 1e-4) << blades << " blades";
  }
}

TEST(Projections, APanoramaIsUprightAndItsMiddleIsAhead) {
  const Camera camera(looking(Projection::panorama), 8, 4);
  EXPECT_LT((camera.ray(4, 2).d - V3f(0, 0, -1)).length(), 1e-6F);
  EXPECT_LT((camera.ray(6, 2).d - V3f(1, 0, 0)).length(), 1e-6F);
  EXPECT_LT((camera.ray(4, 0).d - V3f(0, 1, 0)).length(), 1e-6F);
}

}  // namespace
}  // namespace lacuna
