#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "renderer/core/vec.h"

namespace lacuna {

/// A k-d tree of points, which finds the nearest ones (nanoflann).
class PointTree {
 public:
  PointTree();
  ~PointTree();
  PointTree(PointTree&&) noexcept;
  PointTree& operator=(PointTree&&) noexcept;

  /// At most 2^32 - 1 points.
  void build(std::vector<V3f> points);

  struct Found {
    float distance2;
    std::uint32_t index;
    bool operator<(const Found& o) const { return distance2 < o.distance2; }
  };
  /// Writes the points nearest to `x` to `found`: at most found.size() >= 1, all closer than
  /// sqrt(radius2), the farthest first and the others in any order. Returns their number.
  std::size_t nearest(const V3f& x, float radius2, std::span<Found> found) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;  // null: there are no points
};

}  // namespace lacuna
