#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "analysis/regions/forest_labels.h"
#include "analysis/regions/voxel_face.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The voxel faces that separate two regions (Noel 2015, def. 10.12), a < b.
struct Portal {
  std::uint32_t a = 0, b = 0;
  std::uint64_t first = 0;                 ///< into Portals::voxels
  std::array<std::uint32_t, 6> by_side{};  ///< number of faces at each side of their voxels
  std::uint64_t faces() const;
};

/// All portals of a labelling, ordered by (a, b). A face is stored as its voxel in `a`; faces of
/// one portal are ordered by side, then voxel.
struct Portals {
  std::vector<Portal> portals;
  std::vector<std::uint32_t> voxels;
  std::vector<std::uint32_t> first;      ///< regions + 1 offsets into `of_region`
  std::vector<std::uint32_t> of_region;  ///< indices of the portals of each region, ascending

  std::span<const std::uint32_t> of(std::uint32_t region) const {
    return {of_region.data() + first[region], of_region.data() + first[region + 1]};
  }
  /// Face `i` in [0, portal.faces()), seen from `a`: its normal points into `b`.
  VoxelFace face(const Portal& portal, std::uint64_t i) const;
};

/// Throws MemoryLimitError if it would take more than `byte_limit` bytes.
Portals find_portals(const RegionLabels& labels, const ThreadPool& pool, std::uint64_t byte_limit);

}  // namespace lacuna
