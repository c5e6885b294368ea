#pragma once

#include <span>
#include <vector>

#include "renderer/path/point_tree.h"
#include "renderer/path/vertex.h"

namespace lacuna {

/// A point on a surface and the normal there.
struct SurfacePoint {
  V3f x;  ///< scene units
  V3f n;  ///< unit
};

/// Point `v`, which an eye path hit, with the geometric normal on the side of the ray.
inline SurfacePoint surface_point(const Vertex& v) { return {v.surface.x, v.side()}; }

/// A k-d tree of surface points, which finds the nearest by distance and normal.
class RecordTree {
 public:
  void build(std::vector<SurfacePoint> points);

  /// The distance between two points times (2 - n . n'), scene units.
  static float rank(const SurfacePoint& a, const SurfacePoint& b) {
    return std::sqrt((a.x - b.x).length2()) * (2 - dot(a.n, b.n));
  }

  /// Finds the 2 k nearest points by distance, k = found.size() <= 64, and writes the indices of
  /// the k of lowest rank() into `found`. Returns how many were written: k, or the size of a
  /// smaller tree.
  std::size_t nearest(const SurfacePoint& at, std::span<std::uint32_t> found) const;

 private:
  std::vector<SurfacePoint> points_;
  PointTree tree_;
};

}  // namespace lacuna
