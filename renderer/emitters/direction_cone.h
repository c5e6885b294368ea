#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "renderer/core/vec.h"

namespace lacuna {

/// All unit directions within the angle `spread` of a unit axis.
struct DirectionCone {
  V3d axis{0, 0, 1};
  double spread = 0;  ///< radians, in [0, pi]

  static DirectionCone everything() { return {V3d(0, 0, 1), std::numbers::pi}; }

  /// The narrowest cone that contains both.
  static DirectionCone join(const DirectionCone& a, const DirectionCone& b) {
    const double angle = std::acos(std::clamp(a.axis.dot(b.axis), -1.0, 1.0));
    if (std::min(angle + b.spread, std::numbers::pi) <= a.spread) return a;
    if (std::min(angle + a.spread, std::numbers::pi) <= b.spread) return b;
    const double spread = (a.spread + angle + b.spread) / 2;
    if (spread >= std::numbers::pi) return everything();
    // Rotate the axis of `a` towards that of `b`.
    const V3d across = b.axis - a.axis * a.axis.dot(b.axis);
    const double length = across.length();
    if (!(length > 0)) return everything();
    const double turn = spread - a.spread;
    return {(a.axis * std::cos(turn) + across * (std::sin(turn) / length)).normalized(), spread};
  }
};

}  // namespace lacuna
