#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "renderer/core/vec.h"

namespace lacuna {

/// Directions as texels of a dual paraboloid map (Brabec et al. 2002): two squares of `size` x
/// `size` texels for the half spaces of positive and of negative x. All maps are turned the same
/// way, so that those of views near one another can share texels (Kol et al. 2018, 3.1.3).
struct Paraboloid {
  int size;

  int texels() const { return 2 * size * size; }

  /// A place on the squares, in texels whose corners are whole numbers.
  struct Place {
    int half;    ///< 0: x >= 0
    float u, v;  ///< in [0, size]
  };
  /// `d`: of any length above 0.
  Place place(const V3f& d) const {
    const float scale = 1 / (d.length() + std::abs(d.x));
    const float half = static_cast<float>(size) / 2;
    return {d.x < 0 ? 1 : 0, (d.y * scale + 1) * half, (d.z * scale + 1) * half};
  }
  int texel(const Place& p) const {
    const auto step = [&](float at) { return std::clamp(static_cast<int>(at), 0, size - 1); };
    return index(p.half, step(p.u), step(p.v));
  }
  int texel(const V3f& d) const { return texel(place(d)); }
  int index(int half, int i, int j) const { return (half * size + j) * size + i; }

  /// The unit direction through the middle of a texel. Those of the squares' corners belong to the
  /// other half; nobody asks for them by place().
  V3f direction(int texel) const {
    const int i = texel % size;
    const int j = texel / size % size;
    const float u = (2 * static_cast<float>(i) + 1) / static_cast<float>(size) - 1;
    const float v = (2 * static_cast<float>(j) + 1) / static_cast<float>(size) - 1;
    const float r2 = u * u + v * v;
    const float x = (1 - r2) / (1 + r2);
    const float side = 2 / (1 + r2);
    return {texel < size * size ? x : -x, u * side, v * side};
  }

  /// Texels across the disk that a small sphere shows, at most: twice its radius over its distance
  /// times this. `cosine`: of the angle between its direction and the axis of its half, >= 0. The
  /// angle is stretched by 1 / (1 + cos) towards the rim.
  float stretch(float cosine) const { return static_cast<float>(size) / (2 * (1 + cosine)); }
};

}  // namespace lacuna
