#pragma once

#include <cstdint>
#include <vector>

#include "analysis/geometry/bit_grid.h"
#include "analysis/parallel/thread_pool.h"

namespace lacuna {

enum class Connectivity { faces, corners };  ///< 6: through shared faces; 26: shared corners

/// The component of voxels whose bit is 0.
inline constexpr std::uint32_t no_component = 0xffffffff;

/// Voxels [x0, x1) of one line along x, all in one component.
struct ComponentRun {
  std::uint16_t x0, x1;
  std::uint32_t component;
};

/// The connected components of the 1 bits of a grid, as runs along x: never larger than a label for
/// every voxel, and usually far smaller. Components are numbered by their first voxel, x fastest.
struct Components {
  Imath::V3i size{0};
  std::vector<std::uint32_t> first;  ///< rows + 1 offsets into `runs`; row (y, z) is z * size.y + y
  std::vector<ComponentRun> runs;    ///< ascending along each row, no two of a row touch
  std::vector<std::uint64_t> voxels;  ///< of each component
  std::vector<bool> touches_border;   ///< whether it holds a voxel at a face of the grid

  std::size_t count() const { return voxels.size(); }
  std::size_t row(int y, int z) const {
    return static_cast<std::size_t>(z) * static_cast<std::size_t>(size.y) +
           static_cast<std::size_t>(y);
  }
  /// The component of a voxel of the grid, or no_component.
  std::uint32_t at(Imath::V3i voxel) const;
};

/// Throws MemoryLimitError if it would take more than `byte_limit` bytes.
Components connected_components(const BitGrid3& grid, Connectivity connectivity,
                                const ThreadPool& pool, std::uint64_t byte_limit);

}  // namespace lacuna
