#pragma once

#include <random>

#include "analysis/geometry/bit_grid.h"

namespace lacuna::testing {

/// Voxels at random, alone (`smooth` 0) or as blobs: balls of that radius around random centres.
inline BitGrid3 random_voxels(Imath::V3i size, double density, int smooth, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform;
  BitGrid3 voxels(size), blobs(size);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (uniform(random) >= density) continue;
        voxels.set(x, y, z);
        for (int dz = -smooth; dz <= smooth; ++dz) {
          for (int dy = -smooth; dy <= smooth; ++dy) {
            for (int dx = -smooth; dx <= smooth; ++dx) {
              const Imath::V3i v(x + dx, y + dy, z + dz);
              if (dx * dx + dy * dy + dz * dz <= smooth * smooth && v.x >= 0 && v.y >= 0 &&
                  v.z >= 0 && v.x < size.x && v.y < size.y && v.z < size.z) {
                blobs.set(v);
              }
            }
          }
        }
      }
    }
  }
  return smooth == 0 ? voxels : blobs;
}

}  // namespace lacuna::testing
