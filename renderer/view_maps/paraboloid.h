#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "analysis/geometry/simd.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// Directions as texels of a dual paraboloid map (Brabec et al. 2002): two squares of `size` x
/// `size` texels for the half spaces of positive and of negative x. All maps have the same
/// orientation, so nearby views can share texels (Kol et al. 2018, 3.1.3).
struct Paraboloid {
  int size;

  int texels() const { return 2 * size * size; }

  /// Continuous texel coordinates; texel corners are at integers.
  struct TexelCoord {
    int half;    ///< 0: x >= 0
    float u, v;  ///< in [0, size]
  };
  /// `d`: nonzero, of any length.
  TexelCoord coord(const V3f& d) const {
    const float scale = 1 / (d.length() + std::abs(d.x));
    return {d.x < 0 ? 1 : 0, coordinate(d.y * scale), coordinate(d.z * scale)};
  }
  int texel(const TexelCoord& p) const {
    const auto step = [&](float at) { return std::clamp(static_cast<int>(at), 0, size - 1); };
    return index(p.half, step(p.u), step(p.v));
  }
  int texel(const V3f& d) const { return texel(coord(d)); }
  int index(int half, int i, int j) const { return (half * size + j) * size + i; }
  /// TexelCoord of eight directions.
  struct TexelCoord8 {
    Int8 half;    ///< 0 or `size`: the first row of the square
    Float8 u, v;  ///< as TexelCoord
    Float8 scale;
  };
  /// `length`: the length of each `d`.
  TexelCoord8 coords(const Float8x3& d, Float8 length) const {
    const Float8 scale = Float8(1.0F) / (length + abs(d.x));
    return {keep_where(Float8(0.0F) > d.x, Int8(size)), coordinate(d.y * scale),
            coordinate(d.z * scale), scale};
  }
  Int8 texel(const TexelCoord8& p) const {
    const auto step = [&](Float8 at) { return min(max(truncate(at), Int8(0)), Int8(size - 1)); };
    return (p.half + step(p.v)) * Int8(size) + step(p.u);
  }
  /// Whether spheres of this small radius, with centres at `p`, cover the centres of the texels
  /// that contain `p`.
  Mask8 covers_middle(const TexelCoord8& p, float radius) const {
    const auto off = [](Float8 at) { return at - floor(at) - Float8(0.5F); };
    const Float8 u = off(p.u), v = off(p.v);
    const Float8 across = Float8(radius * static_cast<float>(size) / 2) * p.scale;
    return across * across >= u * u + v * v;
  }

  /// Converts a coordinate in [-1, 1] on the paraboloid's plane to texels. on_plane() is the
  /// inverse.
  template <class F>
  F coordinate(F at) const {
    return (at + F(1.0F)) * F(static_cast<float>(size) / 2);
  }
  float on_plane(float at) const { return at * 2 / static_cast<float>(size) - 1; }

  /// The unit direction through the centre of a texel. Texels at the squares' corners represent
  /// directions of the other half; coord() never returns them.
  V3f direction(int texel) const {
    const float u = on_plane(static_cast<float>(texel % size) + 0.5F);
    const float v = on_plane(static_cast<float>(texel / size % size) + 0.5F);
    const float r2 = u * u + v * v;
    const float x = (1 - r2) / (1 + r2);
    const float side = 2 / (1 + r2);
    return {texel < size * size ? x : -x, u * side, v * side};
  }

  /// Whether coord() returns the texel for some direction: all but those at the squares' corners.
  bool reachable(int texel) const {
    // The point of the texel nearest to the centre of the square.
    const auto nearest = [&](int i) {
      const float at = on_plane(static_cast<float>(i));
      return at < 0 ? std::min(0.0F, on_plane(static_cast<float>(i + 1))) : at;
    };
    const float u = nearest(texel % size);
    const float v = nearest(texel / size % size);
    return u * u + v * v < 1 + 1e-5F;
  }

  /// The image of a small sphere is at most 2 radius / distance * stretch(cosine) texels wide,
  /// `cosine` >= 0 that of the angle between its direction and the axis of its half. Angles are
  /// stretched by 1 / (1 + cos) towards the rim.
  float stretch(float cosine) const { return static_cast<float>(size) / (2 * (1 + cosine)); }

  /// A rectangle of texels of one half: rows [v_first, v_end), columns [u_first, u_end).
  struct Rectangle {
    int v_first = 0, v_end = 0, u_first = 0, u_end = 0;
  };
  /// A rectangle that contains all texels of a half whose centres lie in the cap around unit `w`
  /// with half angle of this cosine and sine.
  Rectangle cap(int half, const V3f& w, float cosine, float sine) const {
    const float x = half == 0 ? w.x : -w.x;
    if (x < -sine) return {};  // beyond the rim
    // The projection is stereographic: the cap's image is the disk, or, if the cap contains the
    // opposite pole, the complement of the disk, a (y^2 + z^2) - 2 (y w.y + z w.z) + cosine - x <=
    // 0.
    const float a = cosine + x;
    if (!(a > 1e-3F)) return {0, size, 0, size};  // nearly a hemisphere, or more
    const float scale = 1 / a;
    // The first texel whose centre is at or beyond a coordinate, with a rounding margin.
    const auto after = [&](float at, float rounding) {
      const float texel = std::ceil(coordinate(at) - 0.5F + rounding);
      return static_cast<int>(std::clamp(texel, 0.0F, static_cast<float>(size)));
    };
    constexpr float rounding = 1e-3F;
    return {after((w.z - sine) * scale, -rounding), after((w.z + sine) * scale, rounding),
            after((w.y - sine) * scale, -rounding), after((w.y + sine) * scale, rounding)};
  }
};

}  // namespace lacuna
