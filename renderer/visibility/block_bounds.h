#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// Where the lights of a block lie and face: most blocks of a closed scene turn their back to a
/// shading point, or lie behind it, as a whole.
class BlockBounds {
 public:
  void add(const V3f& x, const V3f& ng) {
    for (int k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], x[k]);
      high_[k] = std::max(high_[k], x[k]);
      least_[k] = std::min(least_[k], ng[k]);
      most_[k] = std::max(most_[k], ng[k]);
    }
  }

  /// No light of the block lies in front of the plane through `x` with normal `n`, and rounding
  /// does not decide it.
  bool behind(const V3f& x, const V3f& n) const {
    float highest = 0;
    float size = 0;
    for (int k = 0; k < 3; ++k) {
      const float a = n[k] * (low_[k] - x[k]);
      const float b = n[k] * (high_[k] - x[k]);
      highest += std::max(a, b);
      size += std::abs(a) + std::abs(b);
    }
    return highest < -rounding * size;
  }
  /// No light of the block has `x` in front of it.
  bool turned_from(const V3f& x) const {
    float highest = 0;
    float size = 0;
    for (int k = 0; k < 3; ++k) {
      const float a = x[k] - low_[k];
      const float b = x[k] - high_[k];
      const float a_most = std::max(a * least_[k], a * most_[k]);
      const float b_most = std::max(b * least_[k], b * most_[k]);
      highest += std::max(a_most, b_most);
      size += std::abs(a) + std::abs(b);
    }
    return highest < -rounding * size;
  }

 private:
  static constexpr float rounding = 1e-6F;  // a few units in the last place of the sums

  V3f low_{std::numeric_limits<float>::infinity()};
  V3f high_{-std::numeric_limits<float>::infinity()};
  V3f least_{1};  // of the normals' components
  V3f most_{-1};
};

}  // namespace lacuna
