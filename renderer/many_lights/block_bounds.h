#pragma once

#include "analysis/geometry/simd.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// Bounds of the positions and normals of a group of lights, for culling: in a closed scene most
/// groups as a whole face away from a shading point or lie behind it.
class BlockBounds {
 public:
  BlockBounds() = default;
  /// The bounds of one light.
  BlockBounds(const V3f& x, const V3f& ng) : low_(x), high_(x), least_(ng), most_(ng) {}

  void add(const BlockBounds& o) {
    for (int k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], o.low_[k]);
      high_[k] = std::max(high_[k], o.high_[k]);
      least_[k] = std::min(least_[k], o.least_[k]);
      most_[k] = std::max(most_[k], o.most_[k]);
    }
  }

  /// For eight points `x`: whether every light of the block lies behind the plane through x with
  /// normal `n`, by more than the rounding error.
  Mask8 behind(const Float8x3& x, const Float8x3& n) const {
    return below_zero({low_.x - x.x, low_.y - x.y, low_.z - x.z},
                      {high_.x - x.x, high_.y - x.y, high_.z - x.z}, n, n);
  }
  /// For eight points `x`: whether every light of the block faces away from x.
  Mask8 facing_away(const Float8x3& x) const {
    return below_zero({x.x - low_.x, x.y - low_.y, x.z - low_.z},
                      {x.x - high_.x, x.y - high_.y, x.z - high_.z}, all(least_), all(most_));
  }

  /// For eight points `x`: whether every light of the block is further than `distance` from x.
  Mask8 further_than(float distance, const Float8x3& x) const {
    return least_distance2(x) > Float8(distance * distance * (1 + rounding));
  }

  /// Geometric terms of the lights, min(1, received / d) min(1, emitted / d) / d^2 at a distance d.
  struct GeometricTerms {
    Float8 received;  ///< largest |d| cos at the point; 0: all lights lie behind its surface
    Float8 emitted;   ///< the same at a light; 0: all face away
    Float8 least2;    ///< least squared distance of a light: of it the term is an upper bound
    Float8 middle2;   ///< that of the middle of the box, at least size2
    float size2;      ///< half the diagonal squared

    /// The term with the squared distance `d2`; at a distance of 0 infinite.
    Float8 at(Float8 d2) const {
      const Float8 d = sqrt(d2);
      // In this order the minimum of NaN, from 0 / 0, is 1.
      const Float8 cosines = min(received / d, 1) * min(emitted / d, 1);
      return keep_where(received > 0 && emitted > 0, cosines / d2);
    }
  };
  /// For eight points `x` with unit normals `n`. `normals`: false for lights without normals.
  GeometricTerms geometric_terms(const Float8x3& x, const Float8x3& n, bool normals) const {
    const Float8x3 a = all(low_) - x, b = all(high_) - x;
    const auto largest = [](const Largest& l) {
      return select(l.below_zero(), 0, max(l.value, l.size * rounding));
    };
    const V3f half = 0.5F * (high_ - low_);
    const Float8 emitted = largest(largest_dot(a * -1, b * -1, all(least_), all(most_)));
    return {largest(largest_dot(a, b, n, n)),
            normals ? emitted : Float8(std::numeric_limits<float>::infinity()), least_distance2(x),
            max(length2(all(low_ + half) - x), half.length2()), half.length2()};
  }
  /// Squared size, larger where normals differ: as Group::cost() of light_tree_build.cpp.
  double size2() const {
    const double turned = std::min(1.0, double((most_ - least_).length2()) / 8);
    return double((high_ - low_).length2()) * (1 + 3 * turned);
  }

 private:
  static constexpr float rounding = 1e-6F;  // a few units in the last place of the sums

  static Float8x3 all(const V3f& v) { return {v.x, v.y, v.z}; }
  Float8 least_distance2(const Float8x3& x) const {
    const auto off = [](Float8 p, float low, float high) {
      return max(Float8(0.0F), max(Float8(low) - p, p - Float8(high)));
    };
    return length2(
        Float8x3{off(x.x, low_.x, high_.x), off(x.y, low_.y, high_.y), off(x.z, low_.z, high_.z)});
  }
  /// The largest p . n for all p between `a` and `b` and n between `from` and `to`, per component.
  struct Largest {
    Float8 value = 0.0F;
    Float8 size = 0.0F;  ///< of the terms
    Mask8 below_zero() const { return size * -rounding > value; }
  };
  static Mask8 below_zero(const Float8x3& a, const Float8x3& b, const Float8x3& from,
                          const Float8x3& to) {
    return largest_dot(a, b, from, to).below_zero();
  }
  static Largest largest_dot(const Float8x3& a, const Float8x3& b, const Float8x3& from,
                             const Float8x3& to) {
    Largest l;
    const auto add = [&](Float8 p, Float8 q, Float8 n, Float8 m) {
      const Float8 p_most = max(p * n, p * m);
      const Float8 q_most = max(q * n, q * m);
      l.value = l.value + max(p_most, q_most);
      l.size = l.size + abs(p_most) + abs(q_most);
    };
    add(a.x, b.x, from.x, to.x);
    add(a.y, b.y, from.y, to.y);
    add(a.z, b.z, from.z, to.z);
    return l;
  }

  V3f low_{std::numeric_limits<float>::infinity()};
  V3f high_{-std::numeric_limits<float>::infinity()};
  V3f least_{1};  // of the normals' components
  V3f most_{-1};
};

}  // namespace lacuna
