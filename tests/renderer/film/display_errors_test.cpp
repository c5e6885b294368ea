#include "renderer/film/display_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/core/rng.h"
#include "renderer/film/preview.h"

namespace lacuna {
namespace {

std::vector<double> random_picture(std::size_t values, std::uint32_t seed) {
  Rng rng(seed, 0, 0, Rng::Purpose::test);
  std::vector<double> v(values);
  for (double& x : v) x = double(rng.next());
  return v;
}

/// A linear value that is shown as `code`.
double shown_as(int code) {
  const double s = code / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

TEST(DisplayErrors, OfTheSamePictureAreNone) {
  const auto a = random_picture(std::size_t{3} * 20 * 13, 1);
  const DisplayErrors e = display_errors(a, a, 20, 13, 0.7);
  EXPECT_EQ(e.mse, 0);
  EXPECT_EQ(e.psnr, std::numeric_limits<double>::infinity());
  EXPECT_NEAR(e.ssim, 1, 1e-12);
}

TEST(DisplayErrors, AreOfWhatIsShown) {
  for (int code = 0; code <= 255; ++code) EXPECT_EQ(display_code(shown_as(code)), code);
  // Two flat pictures: mse is the difference squared; of SSIM only the means' part remains.
  const std::vector<double> a(std::size_t{3} * 16 * 16, shown_as(100) / 2);
  const std::vector<double> b(a.size(), shown_as(120) / 2);
  const DisplayErrors e = display_errors(a, b, 16, 16, 2);
  EXPECT_NEAR(e.mse, 400, 1e-9);
  EXPECT_NEAR(e.psnr, 10 * std::log10(65025.0 / 400), 1e-9);
  const double c1 = 6.5025;
  EXPECT_NEAR(e.ssim, (2 * 100 * 120 + c1) / (100 * 100 + 120 * 120 + c1), 1e-9);
  // What is brighter than white is white, below zero black.
  const std::vector<double> bright(a.size(), 50.0), white(a.size(), 1.0), negative(a.size(), -3.0);
  EXPECT_EQ(display_errors(bright, white, 16, 16, 1).mse, 0);
  EXPECT_NEAR(display_errors(negative, white, 16, 16, 1).mse, 255 * 255, 1e-9);
}

// Wang et al., eq. 13, at each pixel with the window's weights written out.
TEST(DisplayErrors, SsimIsThatOfItsDefinition) {
  constexpr int w = 14, h = 9;
  const auto a = random_picture(3 * w * h, 2), b = random_picture(3 * w * h, 3);
  const auto luma = [](const std::vector<double>& p, int x, int y) {
    const double* v = p.data() + 3 * (y * w + x);
    return 0.299 * display_code(v[0]) + 0.587 * display_code(v[1]) + 0.114 * display_code(v[2]);
  };
  double total = 0;
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      double all = 0, ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
      for (int v = std::max(0, y - 5); v <= std::min(h - 1, y + 5); ++v) {
        for (int u = std::max(0, x - 5); u <= std::min(w - 1, x + 5); ++u) {
          const double g = std::exp(-((u - x) * (u - x) + (v - y) * (v - y)) / 4.5);
          const double p = luma(a, u, v), q = luma(b, u, v);
          all += g, ma += g * p, mb += g * q, aa += g * p * p, bb += g * q * q, ab += g * p * q;
        }
      }
      ma /= all, mb /= all;
      const double va = aa / all - ma * ma, vb = bb / all - mb * mb, cov = ab / all - ma * mb;
      total += (2 * ma * mb + 6.5025) * (2 * cov + 58.5225) /
               ((ma * ma + mb * mb + 6.5025) * (va + vb + 58.5225));
    }
  }
  EXPECT_NEAR(display_errors(a, b, w, h, 1).ssim, total / (w * h), 1e-9);
  EXPECT_LT(total / (w * h), 0.5);
}

TEST(DisplayErrors, RefuseOtherSizes) {
  const std::vector<double> a(12), b(15);
  EXPECT_THROW(display_errors(a, b, 2, 2, 1), std::invalid_argument);
  EXPECT_THROW(display_errors(a, a, 3, 2, 1), std::invalid_argument);
  EXPECT_THROW(display_errors({}, {}, 0, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace lacuna
