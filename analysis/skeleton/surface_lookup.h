#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <optional>

#include "analysis/geometry/grid.h"
#include "analysis/skeleton/graph.h"

namespace lacuna {

/// Largest distance, in voxels, from a surface point's own voxel to its mapped voxel.
inline constexpr int lookup_reach = 4;

/// Finds the skeleton node that a surface point belongs to (Noel 2015, eq. 151-155).
class SurfaceLookup {
 public:
  /// `map` is a node mapping grid; it is held by reference and must outlive the lookup.
  SurfaceLookup(const GridTransform& transform, const Grid3<std::uint32_t>& map)
      : transform_(transform), map_(&map) {}

  /// The voxel of empty space in front of a surface point: the mapped voxel v around the point's
  /// own voxel s with the largest (v - s) . n, n the normal turned to the side of `w` (eq.
  /// 152-154). `x` in scene units; `n` and `w` of any length; `w` leads from the surface to where
  /// it is seen from. Unlike the thesis, voxels behind the surface or beside it (product not above
  /// 0) are not taken: they may lie beyond a wall. If none of the 26 neighbours will do, shells
  /// further out are tried, up to lookup_reach. If s itself is mapped, it is taken. Among equals
  /// the nearest, then the first in memory. None, if there is no such voxel, if `x` lies more than
  /// half a voxel outside the grid (nearer ones, by rounding, belong to the outermost voxels), if
  /// `n` is 0, or if x, n or w is not finite.
  std::optional<Imath::V3i> voxel(Imath::V3d x, Imath::V3d n, Imath::V3d w) const;

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
