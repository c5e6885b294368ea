#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>

namespace lacuna {

/// One of the six unit squares around a voxel.
struct VoxelFace {
  std::uint32_t voxel = 0;  ///< index in the grid, x fastest
  std::uint8_t side = 0;    ///< 0 .. 5: the face at -x, +x, -y, +y, -z, +z
  int axis() const { return side / 2; }
  bool positive() const { return side % 2 == 1; }
  /// Away from the voxel.
  Imath::V3d normal() const {
    Imath::V3d n(0.0);
    n[axis()] = positive() ? 1 : -1;
    return n;
  }
  /// The point of the face at (u, v) in [0, 1]^2, in voxels, for a face of `at`, its voxel.
  Imath::V3d point(Imath::V3i at, double u, double v) const {
    Imath::V3d p(at);
    const int a = axis();
    p[a] += positive() ? 1 : 0;
    p[(a + 1) % 3] += u;
    p[(a + 2) % 3] += v;
    return p;
  }
  bool operator==(const VoxelFace&) const = default;
};

}  // namespace lacuna
