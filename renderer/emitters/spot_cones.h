#pragma once

#include <cmath>

#include "renderer/core/density.h"
#include "renderer/core/sampling.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// 1 - cos of an angle without cancellation: at 0.01 rad, a float cosine keeps one digit.
inline double one_minus_cos(double angle) {
  const double s = std::sin(angle / 2);
  return 2 * s * s;
}
/// 1 - cos of the angle between unit `a` and `b`: half the squared chord.
inline float one_minus_cos(const V3f& a, const V3f& b) { return (a - b).length2() / 2; }

/// The cones of a spot light (KHR_lights_punctual): full intensity in the inner one, none outside
/// the outer one, and between them the squared ramp
///
///   ((cos a - cos outer) / (cos inner - cos outer))^2
///
/// Cosines are stored as 1 - cos. If both cones are equal, the edge is hard.
class SpotCones {
 public:
  SpotCones() = default;
  /// Radians, half angles: 0 <= inner <= outer.
  SpotCones(double inner, double outer)
      : inner_(static_cast<float>(one_minus_cos(inner))),
        outer_(static_cast<float>(one_minus_cos(outer))) {}

  /// Intensity relative to the axis, at an angle with 1 - cos = `x`.
  float falloff(float x) const {
    if (x >= outer_) return 0;
    if (x <= inner_) return 1;
    const float ramp = (outer_ - x) / (outer_ - inner_);
    return ramp * ramp;
  }
  /// The power of a spot of intensity 1, steradians: its intensity integrated over directions. The
  /// integral of the squared ramp is a third of its width.
  static double power(double inner, double outer) {
    const double inside = one_minus_cos(inner);
    return 2 * std::numbers::pi * (inside + (one_minus_cos(outer) - inside) / 3);
  }
  /// Whether the outer cone contains directions with 1 - cos = `x`.
  bool contains(float x) const { return x < outer_; }
  /// Density of uniform directions in the outer cone.
  Pdf<SolidAngle> pdf() const { return Pdf<SolidAngle>(outer_ > 0 ? 1 / (2 * pi * outer_) : 0); }
  /// 1 - cos of such a direction, from `u` uniform in [0, 1).
  float sample(float u) const { return u * outer_; }

 private:
  float inner_ = 0, outer_ = 1;  // 1 - cos
};

}  // namespace lacuna
