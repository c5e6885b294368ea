#pragma once

#include <limits>

#include "renderer/core/vec.h"

namespace lacuna {

/// An axis-aligned box.
struct Bounds {
  V3d low{std::numeric_limits<double>::infinity()};
  V3d high{-std::numeric_limits<double>::infinity()};

  void add(const V3d& p) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  void add(const V3f& p) { add(V3d(p)); }
  void add(const Bounds& other) {
    for (int k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], other.low[k]);
      high[k] = std::max(high[k], other.high[k]);
    }
  }
  bool empty() const { return !(low.x <= high.x); }
  /// The box around the eight corners, each moved by `move`.
  template <class Move>
  Bounds with_corners_moved(Move&& move) const {
    Bounds box;
    for (int corner = 0; corner < 8; ++corner) {
      V3d p;
      for (int k = 0; k < 3; ++k) p[k] = ((corner >> k) & 1) != 0 ? high[k] : low[k];
      box.add(V3d(move(p)));
    }
    return box;
  }
  V3d size() const { return high - low; }
  /// Half the diagonal.
  double radius() const { return size().length() / 2; }

  /// Areas, projected along unit `w`, of the visible faces of constant x, y and z.
  V3d sides_across(const V3f& w) const {
    const V3d d = size();
    return {d.y * d.z * std::abs(double(w.x)), d.z * d.x * std::abs(double(w.y)),
            d.x * d.y * std::abs(double(w.z))};
  }
  /// Projected area of the box along `w`.
  double area_across(const V3f& w) const {
    const V3d s = sides_across(w);
    return s.x + s.y + s.z;
  }
};

}  // namespace lacuna
