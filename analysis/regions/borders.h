#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/regions/forest_labels.h"
#include "analysis/regions/voxel_face.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Which faces a region's border includes.
enum class BorderFaces {
  portals,  ///< faces to other regions only
  all       ///< also faces to the scene and to the outside of the grid (Noel 2015, 10.4.2)
};

/// The opening border of every region: its faces, with normals that leave the region.
struct Borders {
  /// 6 * regions + 1 offsets into `voxels`: faces of region r at side s are
  /// [first[6 r + s], first[6 r + s + 1]).
  std::vector<std::uint64_t> first;
  std::vector<std::uint32_t> voxels;  ///< of the region; ascending among faces of one side

  std::uint64_t faces(std::uint32_t region) const {
    return first[6 * (std::size_t{region} + 1)] - first[6 * std::size_t{region}];
  }
  /// Face `i` in [0, faces(region)): its normal leaves the region.
  VoxelFace face(std::uint32_t region, std::uint64_t i) const;
};

/// Throws MemoryLimitError if it would take more than `byte_limit` bytes.
Borders find_borders(const RegionLabels& labels, BorderFaces which, const ThreadPool& pool,
                     std::uint64_t byte_limit);

}  // namespace lacuna
