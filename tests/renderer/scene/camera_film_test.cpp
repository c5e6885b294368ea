// The camera seen from the light: where on the film a direction is, how densely samples cover it,
// and how it is spread over pixels.

#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "renderer/scene/camera.h"
#include "tests/renderer/scene/scene_parts.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

/// A film of few pixels, looking neither along an axis nor from the origin.
Camera askew(int width, int height, PixelFilter filter, double yfov = 1.1) {
  test::SceneParts parts;
  parts.eye({3, -1, 2}, {1, 0.5, -1}, yfov);
  return {parts.data.cameras.front(), width, height, filter};
}

float margin_of(PixelFilter filter) { return filter == PixelFilter::box ? 0.0F : 0.5F; }

TEST(CameraFilm, ProjectIsTheInverseOfRay) {
  for (const PixelFilter filter : {PixelFilter::box, PixelFilter::tent}) {
    for (const auto& [width, height, yfov] :
         {std::tuple(8, 6, 1.1), std::tuple(1, 1, 0.1), std::tuple(300, 20, 2.8)}) {
      const Camera camera = askew(width, height, filter, yfov);
      const float margin = margin_of(filter);
      Rng rng(61, 0, 0, Rng::Purpose::test);
      // A direction is rounded to 2^-24, which is many pixels' share where the view is wide.
      const double off_axis = std::hypot(1.0, double(width) / height) * std::tan(yfov / 2);
      const double slack = 2e-6 * height * (1 + off_axis * off_axis);
      for (int i = 0; i < 2000; ++i) {
        // Those outside are not seen; the border itself belongs to rounding.
        const auto place = [&](int size) {
          return (static_cast<float>(size) + 2 * margin + 2) * rng.next() - margin - 1;
        };
        const V2f at(place(width), place(height));
        const auto away = [&](float x, int size) {  // from the border, outwards
          return std::max(-margin - x, x - static_cast<float>(size) - margin);
        };
        const float outside = std::max(away(at.x, width), away(at.y, height));
        if (std::abs(double(outside)) < slack) continue;
        const auto back = camera.project(camera.ray(at.x, at.y).d);
        ASSERT_EQ(back.has_value(), outside < 0) << at.x << ", " << at.y;
        if (!back) continue;
        EXPECT_NEAR(back->x, at.x, slack);
        EXPECT_NEAR(back->y, at.y, slack);
      }
    }
  }
}

TEST(CameraFilm, NothingBehindTheEyeIsSeen) {
  const Camera camera = askew(8, 6, PixelFilter::tent);
  Rng rng(62, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < 1000; ++i) {
    const Ray ray = camera.ray(8 * rng.next(), 6 * rng.next());
    EXPECT_TRUE(camera.project(ray.d));
    EXPECT_FALSE(camera.project(-ray.d));
  }
  EXPECT_FALSE(camera.project(cross(camera.forward(), V3f(0, 1, 0)).normalized()));
}

// density() counts the pixels of a steradian: over all the film sees it adds up to all of them, and
// over a part of it to that part.
TEST(CameraFilm, DensityAddsUpToThePixels) {
  constexpr int width = 8, height = 6;
  const Camera camera = askew(width, height, PixelFilter::box);
  const double diagonal = std::tan(0.55) * std::hypot(1.0, double(width) / height);
  const double least = std::cos(std::atan(diagonal));
  const Frame frame(camera.forward());
  Rng rng(63, 0, 0, Rng::Purpose::test);
  statistics::Moments all;
  std::vector<statistics::Moments> pixels(width * height);
  for (int i = 0; i < 400000; ++i) {
    const V2f u = rng.next2();
    const double c = 1 - double(u.x) * (1 - least), s = std::sqrt(1 - c * c);
    const double phi = 2 * std::numbers::pi * double(u.y);
    const V3f w = frame.to_world(V3f(V3d(s * std::cos(phi), s * std::sin(phi), c)));
    const auto at = camera.project(w);
    const double value =
        at ? double(camera.density(w).value) * 2 * std::numbers::pi * (1 - least) : 0;
    all.add(value);
    for (std::size_t k = 0; k < pixels.size(); ++k) {
      const bool here = at && static_cast<int>(at->x) == static_cast<int>(k) % width &&
                        static_cast<int>(at->y) == static_cast<int>(k) / width;
      pixels[k].add(here ? value : 0);
    }
  }
  const double level = statistics::sidak(1e-6, pixels.size() + 1);
  EXPECT_GT(statistics::z_test(all, width * height), level);
  EXPECT_LT(all.standard_error(), 0.005 * width * height) << "the test has no power";
  for (const auto& p : pixels) EXPECT_GT(statistics::z_test(p, 1), level);
}

// And it is the density of the rays: E 1/density over samples of all pixels is the solid angle that
// the film sees, with the box filter.
TEST(CameraFilm, DensityIsThatOfTheSamples) {
  constexpr int width = 8, height = 6;
  const Camera camera = askew(width, height, PixelFilter::box);
  // A rectangle's solid angle from its foot: 4 asin(ab / sqrt((1 + a^2)(1 + b^2))).
  const double a = std::tan(0.55), b = a * width / height;
  const double expected = 4 * std::asin(a * b / std::sqrt((1 + a * a) * (1 + b * b)));
  Rng rng(64, 0, 0, Rng::Purpose::test);
  statistics::Moments m;
  for (int i = 0; i < 200000; ++i) {
    const V2i pixel(static_cast<int>(rng.next() * width), static_cast<int>(rng.next() * height));
    m.add(width * height / double(camera.density(camera.sample(pixel, rng.next2()).d).value));
  }
  EXPECT_GT(statistics::z_test(m, expected), 1e-6);
  EXPECT_LT(m.standard_error(), 0.005 * expected);
}

TEST(CameraFilm, SplatSharesAddUpToOne) {
  for (const PixelFilter filter : {PixelFilter::box, PixelFilter::tent}) {
    const Camera camera = askew(8, 6, filter);
    const double margin = margin_of(filter);
    Rng rng(65, 0, 0, Rng::Purpose::test);
    for (int i = 0; i < 20000; ++i) {
      const V2f at(10 * rng.next() - 1, 8 * rng.next() - 1);
      double sum = 0;
      std::vector<int> times(8 * 6);
      camera.splat(at, [&](std::uint32_t pixel, float share) {
        ASSERT_LT(pixel, times.size());
        EXPECT_EQ(++times[pixel], 1);
        EXPECT_GT(share, 0);
        sum += double(share);
      });
      // Outside, where the neighbours are missing, the rest is lost; along each axis by itself.
      const auto kept = [&](double x, double size) {
        const double inside = std::min(x, size - x);  // of the border
        if (margin == 0) return inside >= 0 ? 1.0 : 0.0;
        return std::clamp(inside + margin, 0.0, 1.0);
      };
      EXPECT_NEAR(sum, kept(double(at.x), 8) * kept(double(at.y), 6), 1e-5) << at.x << ", " << at.y;
    }
  }
}

// A pixel's samples are spread as splat() spreads what arrives: light and eye mean the same pixel.
TEST(CameraFilm, SplatSharesAreTheDensityOfSamples) {
  constexpr int cells = 4;  // a side of a pixel
  constexpr int width = 5, height = 4, draws = 200000;
  const auto p_value = [&](PixelFilter sampled, PixelFilter splat, const V2i& pixel) {
    const Camera from = askew(width, height, sampled);
    const Camera to = askew(width, height, splat);
    // The film with a rim of one pixel.
    constexpr int across = (width + 2) * cells, down = (height + 2) * cells;
    std::vector<double> observed(across * down), expected(across * down);
    const auto cell = [&](const V2f& at) {
      return static_cast<std::size_t>((at.y + 1) * cells) * across +
             static_cast<std::size_t>((at.x + 1) * cells);
    };
    constexpr int sub = 32;
    for (int j = 0; j < down * sub; ++j) {
      for (int i = 0; i < across * sub; ++i) {
        const V2f at((static_cast<float>(i) + 0.5F) / (cells * sub) - 1,
                     (static_cast<float>(j) + 0.5F) / (cells * sub) - 1);
        to.splat(at, [&](std::uint32_t p, float share) {
          if (p != static_cast<std::uint32_t>(pixel.y * width + pixel.x)) return;
          expected[cell(at)] += draws * double(share) / (cells * sub * cells * sub);
        });
      }
    }
    Rng rng(66, 0, 0, Rng::Purpose::test);
    for (int i = 0; i < draws; ++i) {
      const auto at = from.project(from.sample(pixel, rng.next2()).d);
      // The box's own border may round to the neighbour.
      if (!at) continue;
      const auto within = [&](float x, int first) {
        const float reach = margin_of(sampled);
        return std::clamp(x, static_cast<float>(first) - reach + 1e-4F,
                          static_cast<float>(first + 1) + reach - 1e-4F);
      };
      ++observed[cell({within(at->x, pixel.x), within(at->y, pixel.y)})];
    }
    return statistics::chi_square_test(observed, expected).p;
  };
  const double level = statistics::sidak(1e-6, 4);
  for (const PixelFilter filter : {PixelFilter::box, PixelFilter::tent}) {
    EXPECT_GT(p_value(filter, filter, {2, 1}), level);
    EXPECT_GT(p_value(filter, filter, {0, 3}), level) << "in a corner";
  }
  EXPECT_EQ(p_value(PixelFilter::tent, PixelFilter::box, {2, 1}), 0) << "the test has no power";
}

}  // namespace
}  // namespace lacuna
