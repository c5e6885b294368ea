#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// A right-handed orthonormal frame whose z axis is a given unit vector (Duff et al. 2017,
/// "Building an Orthonormal Basis, Revisited").
struct Frame {
  V3f s, t, n;

  explicit Frame(const V3f& unit_n) : n(unit_n) {
    const float sign = std::copysign(1.0F, n.z);
    const float a = -1.0F / (sign + n.z);
    const float b = n.x * n.y * a;
    s = V3f(1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x);
    t = V3f(b, sign + n.y * n.y * a, -n.y);
  }

  V3f to_local(const V3f& w) const { return {dot(w, s), dot(w, t), dot(w, n)}; }
  V3f to_world(const V3f& w) const { return w.x * s + w.y * t + w.z * n; }
};

}  // namespace lacuna
