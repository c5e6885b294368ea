#pragma once

#include <cstdint>

#include "analysis/geometry/grid.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The index for voxels outside the domain.
inline constexpr std::uint32_t no_voxel = 0xffffffff;

/// The opening map of the 26-distance and one of its opening forests (Noel 2015, 10.3.1 to 10.3.3).
/// The ball of voxel y contains every x with max |x - y| < D(y).
struct OpeningForest {
  /// Omega_infinity: the largest D(y) of all balls that contain the voxel; 0 outside the domain.
  Grid3<std::uint16_t> opening;
  /// Omega_f: the index of the centre of such a ball, itself where no ball is larger than its own
  /// (eq. 181, 182); no_voxel outside the domain.
  Grid3<std::uint32_t> centre;
};

/// Alg. 6 and 7, from the result of chebyshev_distance(). Throws MemoryLimitError if it would take
/// more than `byte_limit` bytes, std::invalid_argument on a grid of more than 2^32 - 2 voxels.
OpeningForest opening_forest(const Grid3<std::uint16_t>& chebyshev, const ThreadPool& pool,
                             std::uint64_t byte_limit);

}  // namespace lacuna
