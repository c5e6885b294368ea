#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "analysis/geometry/grid.h"

namespace lacuna {

/// A box of voxels: [low, high).
struct VoxelBox {
  Imath::V3i low{0}, high{0};

  bool empty() const { return low.x >= high.x || low.y >= high.y || low.z >= high.z; }
  void add(Imath::V3i v) {
    if (empty()) {
      low = v;
      high = v + Imath::V3i(1);
      return;
    }
    for (int a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], v[a]);
      high[a] = std::max(high[a], v[a] + 1);
    }
  }
  void add(const VoxelBox& box) {
    if (box.empty()) return;
    add(box.low);
    add(box.high - Imath::V3i(1));
  }
};

/// Faces that lie together, and how often any of them is drawn.
struct FacePart {
  const VoxelBox* box;  ///< holds the voxels on both sides of all
  std::uint32_t index;  ///< whoever draws them knows what it is
  double weight;
};

/// Parts without doubles.
class FaceParts {
 public:
  void clear() { parts_.clear(); }
  void add(const VoxelBox& box, std::uint32_t index, double weight) {
    for (FacePart& p : parts_) {
      if (p.index == index) {
        p.weight += weight;
        return;
      }
    }
    parts_.push_back({&box, index, weight});
  }
  auto begin() const { return parts_.begin(); }
  auto end() const { return parts_.end(); }

 private:
  std::vector<FacePart> parts_;
};

/// A face between two voxels, crossed by a ray; the voxels may lie outside the grid.
struct CrossedFace {
  Imath::V3i from, to;
  int axis;
  double t;  ///< where on the ray

  /// The side of `from`, as VoxelFace counts.
  std::uint8_t side_of_from() const {
    return static_cast<std::uint8_t>(2 * axis + (to[axis] > from[axis] ? 1 : 0));
  }
};

/// From `x` in direction `w`, of any length but 0, in grid coordinates; for many boxes.
struct GridRay {
  GridRay(const Imath::V3d& from, const Imath::V3d& along)
      : x(from), w(along), inverse(1 / along.x, 1 / along.y, 1 / along.z) {}

  Imath::V3d x, w, inverse;
};

/// Walks along the ray through `box` and calls visit(CrossedFace) at each face between two voxels
/// of it that the ray crosses at x + t w, t > 0, in their order, until visit returns false
/// (Amanatides and Woo 1987): a face's `from` is the `to` of the one before. Where the ray runs
/// through an edge, the face across the lower axis comes first.
template <class Visit>
void for_each_crossed_face(const GridRay& ray, const VoxelBox& box, Visit&& visit) {
  const auto& [x, w, inverse] = ray;
  double enter = 0, leave = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    if (w[a] == 0) {
      if (x[a] < box.low[a] || x[a] >= box.high[a]) return;
      continue;
    }
    const double first = (box.low[a] - x[a]) * inverse[a],
                 second = (box.high[a] - x[a]) * inverse[a];
    enter = std::max(enter, std::min(first, second));
    leave = std::min(leave, std::max(first, second));
  }
  if (!(enter < leave)) return;
  Imath::V3i here;
  Imath::V3d next, apart;
  for (int a = 0; a < 3; ++a) {
    here[a] =
        std::clamp(static_cast<int>(std::floor(x[a] + enter * w[a])), box.low[a], box.high[a] - 1);
    next[a] = w[a] == 0 ? HUGE_VAL : (here[a] + (w[a] > 0 ? 1 : 0) - x[a]) * inverse[a];
    apart[a] = std::abs(inverse[a]);
  }
  for (;;) {
    int axis = next.x <= next.y ? 0 : 1;
    if (next.z < next[axis]) axis = 2;
    Imath::V3i there = here;
    there[axis] += w[axis] > 0 ? 1 : -1;
    if (there[axis] < box.low[axis] || there[axis] >= box.high[axis]) return;
    if (next[axis] > 0 && !visit(CrossedFace{here, there, axis, next[axis]})) return;
    here = there;
    next[axis] += apart[axis];
  }
}

}  // namespace lacuna
