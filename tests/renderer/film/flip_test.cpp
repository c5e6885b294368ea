#include "renderer/film/flip.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

#include "renderer/core/rng.h"

namespace lacuna {
namespace {

// FLIP from the equations of its papers, in double, with the filters as squares of weights.
namespace by_definition {

using Colour = std::array<double, 3>;
using Filter = std::function<double(double x, double y)>;  // of distances in pixels
constexpr double pi = 3.14159265358979323846, per_degree = 3840 * pi / 180;
constexpr Colour white{0.950428545, 1, 1.088900371};

Colour xyz(const Colour& c) {
  const double a = 24577794, b = 12288897, d = 73733382, g = 8788810;
  return {10135552 / a * c[0] + g / a * c[1] + 4435075 / a * c[2],
          2613072 / b * c[0] + g / b * c[1] + 887015 / b * c[2],
          1425312 / d * c[0] + g / d * c[1] + 70074185 / d * c[2]};
}

/// Solves xyz(c) = v by Cramer's rule.
Colour rgb(const Colour& v) {
  const Colour r = xyz({1, 0, 0}), g = xyz({0, 1, 0}), b = xyz({0, 0, 1});
  const auto det = [](const Colour& p, const Colour& q, const Colour& s) {
    return p[0] * (q[1] * s[2] - q[2] * s[1]) - q[0] * (p[1] * s[2] - p[2] * s[1]) +
           s[0] * (p[1] * q[2] - p[2] * q[1]);
  };
  const double all = det(r, g, b);
  return {det(v, g, b) / all, det(r, v, b) / all, det(r, g, v) / all};
}

Colour opponent(const Colour& linear) {
  const Colour v = xyz(linear);
  const double x = v[0] / white[0], y = v[1] / white[1], z = v[2] / white[2];
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Colour from_opponent(const Colour& o) {
  const double y = (o[0] + 16) / 116, x = y + o[1] / 500, z = y - o[2] / 200;
  return rgb({x * white[0], y * white[1], z * white[2]});
}

Colour hunt_lab(const Colour& linear) {
  const Colour v = xyz(linear);
  const auto f = [&](std::size_t k) {
    const double t = v[k] / white[k], delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const double l = 116 * f(1) - 16;
  return {l, 0.01 * l * 500 * (f(0) - f(1)), 0.01 * l * 200 * (f(1) - f(2))};
}

double hyab(const Colour& p, const Colour& q) {
  return std::abs(p[0] - q[0]) + std::hypot(p[1] - q[1], p[2] - q[2]);
}

double colour_error(const Colour& p, const Colour& q) {
  const double cmax = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), 0.7);
  const double e = std::pow(hyab(p, q), 0.7), knee = 0.4 * cmax;
  return e < knee ? 0.95 / knee * e : 0.95 + (e - knee) / (cmax - knee) * 0.05;
}

struct Picture {
  int width, height;
  std::vector<Colour> pixels;
  const Colour& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(std::clamp(y, 0, height - 1) * width +
                                           std::clamp(x, 0, width - 1))];
  }
};

/// The sum over a square of (2 radius + 1)^2 pixels around (x, y), over the sum of the positive
/// and the sum of the negative weights apart.
double filtered(const Picture& p, int x, int y, std::size_t channel, int radius, const Filter& f) {
  double positive = 0, negative = 0, up = 0, down = 0;
  for (int v = -radius; v <= radius; ++v) {
    for (int u = -radius; u <= radius; ++u) {
      const double w = f(u, v);
      (w > 0 ? positive : negative) += std::abs(w);
      (w > 0 ? up : down) += w * p.at(x + u, y + v)[channel];
    }
  }
  return (positive > 0 ? up / positive : 0) + (negative > 0 ? down / negative : 0);
}

Filter sensitivity(double a1, double b1, double a2, double b2) {
  return [=](double x, double y) {
    const double z = (x * x + y * y) / (per_degree * per_degree);
    return a1 * std::sqrt(pi / b1) * std::exp(-pi * pi * z / b1) +
           a2 * std::sqrt(pi / b2) * std::exp(-pi * pi * z / b2);
  };
}

double feature(const Picture& p, int x, int y, bool point) {
  const double sd = 0.5 * 0.082 * per_degree;
  const int radius = static_cast<int>(std::ceil(3 * sd));
  const Filter f = [=](double u, double v) {
    const double g = std::exp(-(u * u + v * v) / (2 * sd * sd));
    return point ? (u * u / (sd * sd) - 1) * g : -u * g;
  };
  const auto turned = [&](double u, double v) { return f(v, u); };
  return std::hypot(filtered(p, x, y, 0, radius, f), filtered(p, x, y, 0, radius, turned)) / 116;
}

Colour seen(const Picture& p, int x, int y) {
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * per_degree));
  Colour c = from_opponent({filtered(p, x, y, 0, radius, sensitivity(1, 0.0047, 0, 1e-5)),
                            filtered(p, x, y, 1, radius, sensitivity(1, 0.0053, 0, 1e-5)),
                            filtered(p, x, y, 2, radius, sensitivity(34.1, 0.04, 13.5, 0.025))});
  for (double& v : c) v = std::clamp(v, 0.0, 1.0);
  return hunt_lab(c);
}

/// `shown`: of both pictures, in [0, 1].
double flip(const Picture& a, const Picture& b, int x, int y) {
  const double colour = colour_error(seen(a, x, y), seen(b, x, y));
  const double edge = std::abs(feature(a, x, y, false) - feature(b, x, y, false));
  const double point = std::abs(feature(a, x, y, true) - feature(b, x, y, true));
  return std::pow(colour, 1 - std::sqrt(std::max(edge, point) / std::sqrt(2.0)));
}

double aces(double x) {
  x *= 0.6;
  return std::clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

template <class Shown>
Picture shown(const std::vector<double>& rgb, int width, int height, const Shown& f) {
  Picture p{width, height, {}};
  for (std::size_t i = 0; i < rgb.size(); i += 3) {
    p.pixels.push_back(opponent({f(rgb[i]), f(rgb[i + 1]), f(rgb[i + 2])}));
  }
  return p;
}

}  // namespace by_definition

/// Radiance over three decades, with a smooth part, so that there are edges and flat regions.
std::vector<double> test_picture(int width, int height, std::uint32_t seed) {
  Rng rng(seed, 0, 0, Rng::Purpose::test);
  std::vector<double> v;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double bright = (x / 16 + y / 16) % 2 == 0 ? 1 : 0.02;
      for (int c = 0; c < 3; ++c) {
        v.push_back(bright * (0.2 + 0.1 * c + double(rng.next())) * (x > 2 * width / 3 ? 20 : 1));
      }
    }
  }
  return v;
}

constexpr std::array<std::array<int, 2>, 6> places{
    {{0, 0}, {31, 17}, {63, 64}, {64, 63}, {128, 40}, {139, 69}}};

TEST(Flip, IsThatOfItsDefinition) {
  constexpr int w = 140, h = 70;
  const auto a = test_picture(w, h, 1), b = test_picture(w, h, 2);
  const auto map = ldr_flip({a, b, w, h}, 0.5);
  const auto clip = [](double v) { return std::clamp(0.5 * v, 0.0, 1.0); };
  const auto pa = by_definition::shown(a, w, h, clip), pb = by_definition::shown(b, w, h, clip);
  for (const auto& [x, y] : places) {
    const double expected = by_definition::flip(pa, pb, x, y);
    EXPECT_GT(expected, 0.001);
    EXPECT_NEAR(map[static_cast<std::size_t>(y * w + x)], expected, 1e-5) << x << ' ' << y;
  }
}

TEST(Flip, OfHdrPicturesIsTheLargestOverExposures) {
  constexpr int w = 140, h = 70;
  const auto a = test_picture(w, h, 3), b = test_picture(w, h, 4);
  const FlipExposures e = flip_exposures(b);
  EXPECT_GE(e.count, 4);
  const auto map = hdr_flip({a, b, w, h}, e);
  for (const auto& [x, y] : places) {
    double expected = 0;
    for (int i = 0; i < e.count; ++i) {
      const auto tone = [&](double v) { return by_definition::aces(std::exp2(e.at(i)) * v); };
      expected = std::max(expected, by_definition::flip(by_definition::shown(a, w, h, tone),
                                                        by_definition::shown(b, w, h, tone), x, y));
    }
    EXPECT_NEAR(map[static_cast<std::size_t>(y * w + x)], expected, 1e-5) << x << ' ' << y;
  }
}

TEST(Flip, ExposesTheBrightestAndTheMedianPixelAlike) {
  std::vector<double> grey;
  for (const double v : {0.0, 0.0, 0.25, 1.0, 8.0}) grey.insert(grey.end(), 3, v);
  const FlipExposures e = flip_exposures(grey);
  EXPECT_NEAR(by_definition::aces(8 * std::exp2(e.at(0))), 0.85, 1e-12);
  EXPECT_NEAR(by_definition::aces(1 * std::exp2(e.at(e.count - 1))), 0.85, 1e-12);
  EXPECT_EQ(e.count, 3);
  // A grey picture: still two exposures. A black one: nothing to expose.
  EXPECT_EQ(flip_exposures(std::vector<double>(12, 2.0)).count, 2);
  EXPECT_EQ(flip_exposures(std::vector<double>(12, 0.0)).count, 1);
}

TEST(Flip, HoldsWhatADifferenceMust) {
  constexpr int w = 65, h = 33;
  const auto a = test_picture(w, h, 5), b = test_picture(w, h, 6);
  const FlipExposures e = flip_exposures(b);
  EXPECT_EQ(flip_mean(ldr_flip({a, a, w, h}, 1)), 0);
  EXPECT_EQ(flip_mean(hdr_flip({a, a, w, h}, e)), 0);
  EXPECT_EQ(ldr_flip({a, b, w, h}, 1), ldr_flip({b, a, w, h}, 1));
  const ThreadPool pool(3);
  EXPECT_EQ(hdr_flip({a, b, w, h}, e, &pool), hdr_flip({a, b, w, h}, e));
  // Black and white differ less than green and blue, whose difference is 1.
  std::vector<double> black(3, 0.0), white(3, 1.0), green{0, 1, 0}, blue{0, 0, 1};
  EXPECT_NEAR(ldr_flip({green, blue, 1, 1}, 1)[0], 1, 1e-3);
  EXPECT_NEAR(ldr_flip({black, white, 1, 1}, 1)[0],
              by_definition::colour_error({0, 0, 0}, {100, 0, 0}), 1e-5);
  // The unit of radiance does not matter to HDR-FLIP.
  std::vector<double> a2 = a, b2 = b;
  for (double& v : a2) v *= 1024;
  for (double& v : b2) v *= 1024;
  EXPECT_NEAR(flip_mean(hdr_flip({a2, b2, w, h}, flip_exposures(b2))),
              flip_mean(hdr_flip({a, b, w, h}, e)), 1e-6);
}

TEST(Flip, TellsBadValuesAndSizes) {
  std::vector<double> a(std::size_t{3} * 40 * 30, 0.5), b = a;
  a[0] = std::nan("");
  EXPECT_TRUE(std::isnan(flip_mean(ldr_flip({a, b, 40, 30}, 1))));
  a[0] = std::numeric_limits<double>::infinity();
  EXPECT_LE(flip_mean(hdr_flip({a, b, 40, 30}, flip_exposures(b))), 1);
  a[0] = -7;
  EXPECT_GT(flip_mean(hdr_flip({a, b, 40, 30}, flip_exposures(b))), 0);
  EXPECT_THROW(ldr_flip({a, b, 40, 31}, 1), std::invalid_argument);
  EXPECT_THROW(ldr_flip({{}, {}, 0, 0}, 1), std::invalid_argument);
}

}  // namespace
}  // namespace lacuna
