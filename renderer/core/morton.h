#pragma once

#include <cstdint>

#include "renderer/core/bounds.h"

namespace lacuna {

/// The place of a point along a curve that fills a box, in 2^21 steps along each axis: points that
/// follow one another lie near one another (Morton 1966).
class MortonOrder {
 public:
  explicit MortonOrder(const Bounds& box) : low_(box.low) {
    const V3d size = box.size();
    const double longest = std::max(size.x, std::max(size.y, size.z));
    scale_ = longest > 0 ? (0x1p21 - 1) / longest : 0;
  }

  /// `p` must lie in the box.
  std::uint64_t operator()(const V3f& p) const {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
      code |= spread(static_cast<std::uint64_t>((double(p[k]) - low_[k]) * scale_)) << k;
    }
    return code;
  }

 private:
  /// Bit i to bit 3 i, for 21 bits.
  static std::uint64_t spread(std::uint64_t v) {
    v = (v | v << 32) & 0x1f00000000ffff;
    v = (v | v << 16) & 0x1f0000ff0000ff;
    v = (v | v << 8) & 0x100f00f00f00f00f;
    v = (v | v << 4) & 0x10c30c30c30c30c3;
    return (v | v << 2) & 0x1249249249249249;
  }

  V3d low_;
  double scale_;
};

}  // namespace lacuna
