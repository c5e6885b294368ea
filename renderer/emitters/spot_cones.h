#pragma once

#include <cmath>

#include "renderer/core/density.h"
#include "renderer/core/sampling.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// 1 - cos of an angle, without the cancellation: of 0.01 rad, a cosine in float keeps one digit.
inline double one_minus_cos(double angle) {
  const double s = std::sin(angle / 2);
  return 2 * s * s;
}
/// The same of the angle between unit `a` and `b`: half the squared chord.
inline float one_minus_cos(const V3f& a, const V3f& b) { return (a - b).length2() / 2; }

/// The cones of a spot light (KHR_lights_punctual): full intensity in the inner one, none outside
/// the outer one, and between them the squared ramp
///
///   ((cos a - cos outer) / (cos inner - cos outer))^2
///
/// Cosines are kept as 1 - cos. Where both cones are one, their edge is hard.
class SpotCones {
 public:
  SpotCones() = default;
  /// Radians, half angles: 0 <= inner <= outer.
  SpotCones(double inner, double outer)
      : inner_(static_cast<float>(one_minus_cos(inner))),
        outer_(static_cast<float>(one_minus_cos(outer))) {}

  /// Of the intensity on the axis, at 1 - cos `x` of the angle to it.
  float falloff(float x) const {
    if (x >= outer_) return 0;
    if (x <= inner_) return 1;
    const float ramp = (outer_ - x) / (outer_ - inner_);
    return ramp * ramp;
  }
  /// The power of a spot of intensity 1, its intensity integrated over directions: steradians. The
  /// integral of the squared ramp is a third of its width.
  static double power(double inner, double outer) {
    const double inside = one_minus_cos(inner);
    return 2 * std::numbers::pi * (inside + (one_minus_cos(outer) - inside) / 3);
  }
  /// Whether the outer cone contains directions at 1 - cos `x`.
  bool contains(float x) const { return x < outer_; }
  /// Density of directions that are uniform in the outer cone.
  Pdf<SolidAngle> pdf() const { return Pdf<SolidAngle>(outer_ > 0 ? 1 / (2 * pi * outer_) : 0); }
  /// 1 - cos of such a direction, by `u` uniform in [0, 1).
  float sample(float u) const { return u * outer_; }

 private:
  float inner_ = 0, outer_ = 1;  // 1 - cos
};

}  // namespace lacuna
