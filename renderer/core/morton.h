#pragma once

#include <cstdint>

#include "analysis/geometry/morton.h"
#include "renderer/core/bounds.h"

namespace lacuna {

/// The Morton code of a point in a box, with 2^21 steps along the longest axis: points with similar
/// codes are close together (Morton 1966).
class MortonOrder {
 public:
  explicit MortonOrder(const Bounds& box) : low_(box.low) {
    const V3d size = box.size();
    const double longest = std::max(size.x, std::max(size.y, size.z));
    scale_ = longest > 0 ? (0x1p21 - 1) / longest : 0;
  }

  /// `p` must lie in the box.
  std::uint64_t operator()(const V3f& p) const {
    const auto step = [&](int k) {
      return static_cast<std::uint64_t>((double(p[k]) - low_[k]) * scale_);
    };
    return morton_code(step(0), step(1), step(2));
  }

 private:
  V3d low_;
  double scale_;
};

}  // namespace lacuna
