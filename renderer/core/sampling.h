#pragma once

#include <numbers>

#include "renderer/core/density.h"
#include "renderer/core/vec.h"

namespace lacuna {

inline constexpr float pi = std::numbers::pi_v<float>;
inline constexpr float inv_pi = 1 / pi;

/// Barycentric (u, v) of a uniform point on a triangle (Heitz 2019, "A Low-Distortion Map Between
/// Triangle and Square"): keeps neighbours together, needs no square root.
inline V2f sample_triangle(const V2f& u) {
  if (u.y > u.x) {
    const float b = u.x * 0.5F;
    return {b, u.y - b};
  }
  const float b = u.y * 0.5F;
  return {u.x - b, b};
}

}  // namespace lacuna
