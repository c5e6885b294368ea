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

/// A group of faces and its probability.
struct FacePart {
  const VoxelBox* box;  ///< bounds of the voxels on both sides of the faces
  std::uint32_t index;  ///< of the region or portal, see Faces::add_parts()
  double weight;
};

/// Groups of faces, each index at most once.
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

/// A face between two voxels that a ray crosses; the voxels may lie outside the grid.
struct CrossedFace {
  Imath::V3i from, to;
  int axis;
  double t;  ///< ray parameter of the crossing

  /// The side of `from`, numbered as in VoxelFace.
  std::uint8_t side_of_from() const {
    return static_cast<std::uint8_t>(2 * axis + (to[axis] > from[axis] ? 1 : 0));
  }
};

/// A ray from `x` along `w` (nonzero, of any length) in grid coordinates, with precomputed 1 / w.
struct GridRay {
  GridRay(const Imath::V3d& from, const Imath::V3d& along)
      : x(from), w(along), inverse(1 / along.x, 1 / along.y, 1 / along.z) {}

  Imath::V3d x, w, inverse;
};

/// Traverses the voxels of `box` along the ray (Amanatides and Woo 1987) and calls
/// visit(CrossedFace) at each face between two of them that the ray crosses at x + t w, t > 0, in
/// ascending t, until visit returns false. The `from` of a face is the `to` of the previous one. If
/// the ray passes through an edge, the face across the lower axis comes first.
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
