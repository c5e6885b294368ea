#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "analysis/geometry/simd.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// Directions as texels of a dual paraboloid map (Brabec et al. 2002): two squares of
/// `size` x `size` texels for the half spaces of positive and of negative x. All maps are turned
/// the same way, so that those of views near one another can share texels (Kol et al. 2018, 3.1.3).
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
    return {d.x < 0 ? 1 : 0, coordinate(d.y * scale), coordinate(d.z * scale)};
  }
  int texel(const Place& p) const {
    const auto step = [&](float at) { return std::clamp(static_cast<int>(at), 0, size - 1); };
    return index(p.half, step(p.u), step(p.v));
  }
  int texel(const V3f& d) const { return texel(place(d)); }
  int index(int half, int i, int j) const { return (half * size + j) * size + i; }
  /// Those of eight directions.
  struct Eight {
    Int8 half;    ///< 0 or `size`: the square's first row
    Float8 u, v;  ///< as Place
    Float8 scale;
  };
  /// `length`: of each `d`.
  Eight places(const Float8x3& d, Float8 length) const {
    const Float8 scale = Float8(1.0F) / (length + abs(d.x));
    return {keep_where(Float8(0.0F) > d.x, Int8(size)), coordinate(d.y * scale),
            coordinate(d.z * scale), scale};
  }
  Int8 texel(const Eight& p) const {
    const auto step = [&](Float8 at) { return min(max(truncate(at), Int8(0)), Int8(size - 1)); };
    return (p.half + step(p.v)) * Int8(size) + step(p.u);
  }
  /// Whether small spheres of this radius at those places cover the middles of the texels that
  /// their own middles fall into.
  Mask8 covers_middle(const Eight& p, float radius) const {
    const auto off = [](Float8 at) { return at - floor(at) - Float8(0.5F); };
    const Float8 u = off(p.u), v = off(p.v);
    const Float8 across = Float8(radius * static_cast<float>(size) / 2) * p.scale;
    return across * across >= u * u + v * v;
  }

  /// From a coordinate in [-1, 1], on the paraboloid's plane, to one in texels, and back.
  template <class F>
  F coordinate(F at) const {
    return (at + F(1.0F)) * F(static_cast<float>(size) / 2);
  }
  float on_plane(float at) const { return at * 2 / static_cast<float>(size) - 1; }

  /// The unit direction through the middle of a texel. Those of the squares' corners belong to the
  /// other half; nobody asks for them by place().
  V3f direction(int texel) const {
    const float u = on_plane(static_cast<float>(texel % size) + 0.5F);
    const float v = on_plane(static_cast<float>(texel / size % size) + 0.5F);
    const float r2 = u * u + v * v;
    const float x = (1 - r2) / (1 + r2);
    const float side = 2 / (1 + r2);
    return {texel < size * size ? x : -x, u * side, v * side};
  }

  /// Whether place() gives a texel for some direction: all but those of the squares' corners.
  bool asked_for(int texel) const {
    // Of its square, the point that is nearest to the middle.
    const auto nearest = [&](int i) {
      const float at = on_plane(static_cast<float>(i));
      return at < 0 ? std::min(0.0F, on_plane(static_cast<float>(i + 1))) : at;
    };
    const float u = nearest(texel % size);
    const float v = nearest(texel / size % size);
    return u * u + v * v < 1 + 1e-5F;
  }

  /// Texels across the disk that a small sphere shows, at most: twice its radius over its distance
  /// times this. `cosine`: of the angle between its direction and the axis of its half, >= 0. The
  /// angle is stretched by 1 / (1 + cos) towards the rim.
  float stretch(float cosine) const { return static_cast<float>(size) / (2 * (1 + cosine)); }

  /// Calls `use(first, n)` for the runs of texels whose middles lie in the cap around the unit
  /// direction `w` whose half angle has this cosine and sine; each once, but for some of the
  /// squares' corners.
  template <class Use>
  void for_each_run(const V3f& w, float cosine, float sine, Use&& use) const {
    for (int half = 0; half < 2; ++half) {
      run_half(half, {half == 0 ? w.x : -w.x, w.y, w.z}, cosine, sine, use);
    }
  }

 private:
  /// The projection is stereographic: the cap's image is the disk, or where it holds the opposite
  /// pole all but the disk, of a (y^2 + z^2) - 2 (y w.y + z w.z) + cosine - w.x <= 0.
  template <class Use>
  void run_half(int half, const V3f& w, float cosine, float sine, Use&& use) const {
    if (w.x < -sine) return;  // behind the rim
    const float a = cosine + w.x;
    // The first texel whose middle is at a place or after it.
    const auto after = [&](float at) {
      const float texel = std::ceil(coordinate(at) - 0.5F);
      return static_cast<int>(std::clamp(texel, 0.0F, static_cast<float>(size)));
    };
    const bool disk = a > 1e-3F;  // else nearly half of everything, or more
    const int from = disk ? after((w.z - sine) / a) : 0;
    const int to = disk ? after((w.z + sine) / a) : size;
    for (int j = from; j < to; ++j) {
      const float z = on_plane(static_cast<float>(j) + 0.5F);
      const float rest = a * z * z - 2 * z * w.z + cosine - w.x;
      if (!disk) {
        for (int i = 0; i < size; ++i) {
          const float y = on_plane(static_cast<float>(i) + 0.5F);
          if (a * y * y - 2 * y * w.y + rest <= 0) use(index(half, i, j), 1);
        }
        continue;
      }
      const float root2 = w.y * w.y - a * rest;
      if (root2 < 0) continue;
      const float root = std::sqrt(root2);
      const int first = after((w.y - root) / a);
      const int end = after((w.y + root) / a);
      if (end > first) use(index(half, first, j), end - first);
    }
  }
};

}  // namespace lacuna
