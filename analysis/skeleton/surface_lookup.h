#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <optional>

#include "analysis/geometry/grid.h"
#include "analysis/skeleton/graph.h"

namespace lacuna {

/// Largest distance, in voxels, from a surface point's own voxel to its mapped voxel.
inline constexpr int lookup_reach = 4;

/// The offset to the corner, edge or face of a voxel that `n` points to.
inline Imath::V3i sign_of(const Imath::V3d& n) {
  const auto sign = [](double v) { return (v > 0) - (v < 0); };
  return {sign(n.x), sign(n.y), sign(n.z)};
}

/// Finds the skeleton node that a surface point belongs to (Noel 2015, eq. 151-155).
class SurfaceLookup {
 public:
  /// `map` is a node mapping grid; it is held by reference and must outlive the lookup.
  SurfaceLookup(const GridTransform& transform, const Grid3<std::uint32_t>& map)
      : transform_(transform), map_(&map) {}

  /// The voxel of empty space in front of a surface point: the mapped voxel v around the point's
  /// own voxel s with the largest (v - s) . n, n the normal turned to the side of `w` (eq.
  /// 152-154). `x` in scene units; `n` and `w` of any length; `w` points from the surface to the
  /// viewer. Unlike the thesis, excludes voxels behind the surface or beside it (product not above
  /// 0), which may lie beyond a wall. If none of the 26 neighbours qualifies, searches further
  /// shells, up to lookup_reach. Returns s itself if it is mapped. Among equals returns the
  /// nearest, then the first in memory. None if there is no such voxel, if `x` lies more than half
  /// a voxel outside the grid (nearer points, by rounding, belong to the outermost voxels), if `n`
  /// is 0, or if x, n or w is not finite.
  std::optional<Imath::V3i> voxel(Imath::V3d x, Imath::V3d n, Imath::V3d w) const;

  /// Prefetches the map entries that voxel() with the same arguments reads first, and returns the
  /// index of its most likely result; none if `x` lies outside the grid.
  std::optional<std::size_t> prefetch(const Imath::V3d& x, const Imath::V3d& n,
                                      const Imath::V3d& w) const {
    const Imath::V3i size = map_->size();
    const std::optional<Imath::V3i> s = voxel_at(transform_.to_grid(x), size);
    if (!s) return {};
    const double side = n.dot(w) < 0 ? -1 : 1;
    const Imath::V3i front = *s + sign_of(n * side);
    __builtin_prefetch(&(*map_)(*s));
    const std::size_t i = map_->index(in_grid(front, size) ? front : *s);
    __builtin_prefetch(&(*map_)[i]);
    return i;
  }

  /// The node of that voxel (eq. 155), or no_node.
  std::uint32_t node(Imath::V3d x, Imath::V3d n, Imath::V3d w) const {
    const std::optional<Imath::V3i> v = voxel(x, n, w);
    return v ? (*map_)(*v) : no_node;
  }

 private:
  GridTransform transform_;
  const Grid3<std::uint32_t>* map_;
};

}  // namespace lacuna
