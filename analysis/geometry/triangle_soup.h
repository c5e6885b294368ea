#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace lacuna {

/// The input of the analysis: the triangles of a scene in world space, in any order. Every index is
/// below the size of its `positions` and every coordinate is finite (the scene loader ensures it).
struct TriangleSoup {
  using Triangle = std::array<std::uint32_t, 3>;  ///< three indices into positions

  std::vector<Imath::V3f> positions;  ///< scene units
  std::vector<Triangle> triangles;

  /// Triangles that are stored once and placed by transforms. Each position is of some triangle.
  struct Prototype {
    std::vector<Imath::V3f> positions;  ///< in coordinates of their own
    std::vector<Triangle> triangles;
  };
  /// A prototype in the scene: x_scene = x.x axes[0] + x.y axes[1] + x.z axes[2] + at.
  struct Placement {
    std::size_t prototype = 0;
    std::array<Imath::V3f, 3> axes;
    Imath::V3f at;
    std::uint64_t first = 0;  ///< the index of its first triangle; set by place()

    Imath::V3d point(const Imath::V3f& p) const {
      return Imath::V3d(axes[0]) * double(p.x) + Imath::V3d(axes[1]) * double(p.y) +
             Imath::V3d(axes[2]) * double(p.z) + Imath::V3d(at);
    }
  };
  std::vector<Prototype> prototypes;
  std::vector<Placement> placements;

  /// Adds a placement. All prototypes and `triangles` are there.
  void place(Placement placement) {
    placement.first = size();
    placements.push_back(placement);
  }

  /// The number of triangles in the scene: `triangles`, then those of each placement.
  std::uint64_t size() const {
    if (placements.empty()) return triangles.size();
    const Placement& last = placements.back();
    return last.first + prototypes[last.prototype].triangles.size();
  }
  /// The corners of triangle `i` < size(), scene units.
  std::array<Imath::V3d, 3> corners(std::uint64_t i) const {
    std::array<Imath::V3d, 3> c;
    if (i < triangles.size()) {
      for (std::size_t k = 0; k < 3; ++k) c[k] = Imath::V3d(positions[triangles[i][k]]);
      return c;
    }
    const auto after = std::upper_bound(placements.begin(), placements.end(), i,
                                        [](auto index, const auto& p) { return index < p.first; });
    const Placement& placement = *(after - 1);
    const Prototype& prototype = prototypes[placement.prototype];
    const Triangle& t = prototype.triangles[i - placement.first];
    for (std::size_t k = 0; k < 3; ++k) c[k] = placement.point(prototype.positions[t[k]]);
    return c;
  }
};

}  // namespace lacuna
