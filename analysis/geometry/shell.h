#pragma once

#include <Imath/ImathVec.h>

#include <cstdlib>

namespace lacuna {

/// Calls visit(offset) for all offsets whose largest coordinate is +-radius, x fastest, then y,
/// then z: the cubic shell of voxels around one. `radius` above 0.
template <class Visit>
void for_each_in_shell(int radius, Visit&& visit) {
  for (int z = -radius; z <= radius; ++z)
    for (int y = -radius; y <= radius; ++y) {
      const bool full = std::abs(z) == radius || std::abs(y) == radius;
      for (int x = -radius; x <= radius; x += full ? 1 : 2 * radius) visit(Imath::V3i(x, y, z));
    }
}

/// Finds the voxel of a shell that lies furthest along a normal (Noel 2015, eq. 154): the one with
/// the largest dot product > 0 of offset and normal; among equals the nearest, then the first.
struct BestAlongNormal {
  double product = 0;
  int length2 = 0;
  Imath::V3i voxel{0};

  bool found() const { return length2 > 0; }
  /// Whether a voxel at `offset` with dot product `p` is better.
  bool beaten_by(double p, Imath::V3i offset) const {
    return p > product || (found() && p == product && offset.dot(offset) < length2);
  }
  void take(double p, Imath::V3i offset, Imath::V3i v) { *this = {p, offset.dot(offset), v}; }
};

}  // namespace lacuna
