#include "renderer/materials/beckmann.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "renderer/core/sampling.h"

namespace lacuna {
namespace {

constexpr double inv_sqrt_pi = std::numbers::inv_sqrtpi;

/// The visible slopes of a surface of width 1 along the direction of view, which has this cosine
/// and sine: slope x, towards the viewer negative, has the density (cos - x sin) exp(-x^2) /
/// sqrt(pi) over its integral, up to the slope cos / sin that is seen edge-on.
class VisibleSlopes {
 public:
  VisibleSlopes(double cos, double sin) : cos_(cos), sin_(sin) {}

  /// The slope below which the share `u` in (0, 1) of the visible area lies: the root of area(x) =
  /// u area(end), by Newton's method within a bracket that is halved where it fails.
  double at(double u) const {
    constexpr double widest = 6;  // exp(-36): beyond what a float's u reaches
    const double end = sin_ * widest > cos_ ? cos_ / sin_ : widest;
    const double target = u * area(end);
    double low = -widest, high = end, x = std::min(0.0, end);
    for (int i = 0; i < 60; ++i) {
      const double excess = area(x) - target;
      (excess > 0 ? high : low) = x;
      const double slope = (cos_ - x * sin_) * std::exp(-x * x) * inv_sqrt_pi;
      const double next = x - excess / slope;
      const double before = x;
      x = next > low && next < high ? next : 0.5 * (low + high);
      if (std::abs(x - before) < 1e-9) break;
    }
    return x;
  }

 private:
  /// The projected area of the slopes below x.
  double area(double x) const {
    return 0.5 * cos_ * std::erfc(-x) + 0.5 * sin_ * inv_sqrt_pi * std::exp(-x * x);
  }

  double cos_, sin_;
};

}  // namespace

float beckmann_d(const V3f& m, const V2f& alpha) {
  if (!(m.z > 0)) return 0;
  const float x = m.x / alpha.x, y = m.y / alpha.y, z2 = m.z * m.z;
  const float tan2 = (x * x + y * y) / z2;  // of a surface of width 1
  if (!(tan2 < 80)) return 0;               // below the smallest floats
  return std::exp(-tan2) * inv_pi / (alpha.x * alpha.y * z2 * z2);
}

float beckmann_g1_over_cos(const V3f& w, const V2f& alpha) {
  const float x = w.x * alpha.x, y = w.y * alpha.y;
  const float spread = std::sqrt(x * x + y * y);
  // G1 = 1 / (1 + Lambda), Lambda = exp(-a^2) / (2 a sqrt(pi)) - erfc(a) / 2, a = cos / spread.
  const double a = double(w.z) / std::max(double(spread), std::numeric_limits<double>::min());
  if (a > 6) return 1 / w.z;
  const double lambda_cos =  // Lambda times the cosine
      0.5 * (double(spread) * inv_sqrt_pi * std::exp(-a * a) - double(w.z) * std::erfc(a));
  return static_cast<float>(1 / (double(w.z) + lambda_cos));
}

V3f beckmann_sample_visible(const V3f& wo, const V2f& alpha, const V2f& u) {
  // Stretched by the widths, the slopes have width 1 in all directions.
  const V3f v = V3f(alpha.x * wo.x, alpha.y * wo.y, wo.z).normalized();
  const double sin = std::sqrt(double(v.x) * double(v.x) + double(v.y) * double(v.y));
  const auto open = [](float of_cell) { return double(of_cell) + 0x1p-25; };  // in (0, 1)
  const double along = VisibleSlopes(double(v.z), sin).at(open(u.x));
  const double across = VisibleSlopes(1, 0).at(open(u.y));
  const double c = sin > 0 ? double(v.x) / sin : 1.0, s = sin > 0 ? double(v.y) / sin : 0.0;
  // The normal of slopes (x, y) is (-x, -y, 1).
  const V3d m(-double(alpha.x) * (c * along - s * across),
              -double(alpha.y) * (s * along + c * across), 1);
  return V3f(m.normalized());
}

}  // namespace lacuna
