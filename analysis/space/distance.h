#pragma once

#include <cstdint>

#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/grid.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Distance maps (Noel 2015, 6.2.2, 10.3.1): for every voxel the distance to the nearest voxel that
/// is not in the domain, between voxel centres, in voxels; 0 outside the domain. The outside of the
/// grid counts as scene, so a voxel at the grid's face has at most distance 1. Exact, in linear
/// time, the same bits for any number of threads. All throw MemoryLimitError if they would take
/// more than `byte_limit` bytes.

/// D_1: |dx| + |dy| + |dz|.
Grid3<std::uint16_t> l1_distance(const BitGrid3& domain, const ThreadPool& pool,
                                 std::uint64_t byte_limit);

/// D_infinity: max(|dx|, |dy|, |dz|), also called chessboard or 26-distance.
Grid3<std::uint16_t> chebyshev_distance(const BitGrid3& domain, const ThreadPool& pool,
                                        std::uint64_t byte_limit);

/// The square of the Euclidean distance, dx^2 + dy^2 + dz^2.
Grid3<std::uint32_t> squared_distance(const BitGrid3& domain, const ThreadPool& pool,
                                      std::uint64_t byte_limit);

}  // namespace lacuna
