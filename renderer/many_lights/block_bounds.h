#pragma once

#include "analysis/geometry/simd.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// Bounds of the positions and normals of a block's lights, for culling: in a closed scene most
/// blocks as a whole face away from a shading point or lie behind it.
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
    const auto off = [](Float8 p, float low, float high) {
      return max(Float8(0.0F), max(Float8(low) - p, p - Float8(high)));
    };
    const Float8x3 d{off(x.x, low_.x, high_.x), off(x.y, low_.y, high_.y),
                     off(x.z, low_.z, high_.z)};
    return length2(d) > Float8(distance * distance * (1 + rounding));
  }

 private:
  static constexpr float rounding = 1e-6F;  // a few units in the last place of the sums

  static Float8x3 all(const V3f& v) { return {v.x, v.y, v.z}; }
  /// Whether p . n < 0 for all p between `a` and `b` and n between `from` and `to`, per component.
  static Mask8 below_zero(const Float8x3& a, const Float8x3& b, const Float8x3& from,
                          const Float8x3& to) {
    Float8 highest = 0.0F;
    Float8 size = 0.0F;
    const auto add = [&](Float8 p, Float8 q, Float8 n, Float8 m) {
      const Float8 p_most = max(p * n, p * m);
      const Float8 q_most = max(q * n, q * m);
      highest = highest + max(p_most, q_most);
      size = size + abs(p_most) + abs(q_most);
    };
    add(a.x, b.x, from.x, to.x);
    add(a.y, b.y, from.y, to.y);
    add(a.z, b.z, from.z, to.z);
    return size * -rounding > highest;
  }

  V3f low_{std::numeric_limits<float>::infinity()};
  V3f high_{-std::numeric_limits<float>::infinity()};
  V3f least_{1};  // of the normals' components
  V3f most_{-1};
};

}  // namespace lacuna
