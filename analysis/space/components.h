#pragma once

#include "analysis/geometry/bit_grid.h"
#include "analysis/space/run_components.h"

namespace lacuna {

/// The connected components of the 1 bits of a grid.
struct Components : RunComponents {
  std::vector<std::uint64_t> voxels;  ///< of each component
  std::vector<bool> touches_border;   ///< whether it contains a voxel at a face of the grid
};

/// Throws as label_runs().
Components connected_components(const BitGrid3& grid, Connectivity connectivity,
                                const ThreadPool& pool, std::uint64_t byte_limit);

}  // namespace lacuna
