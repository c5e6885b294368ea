#pragma once

#include <cstdint>
#include <vector>

#include "analysis/geometry/grid.h"
#include "analysis/space/opening.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The label of voxels outside the domain.
inline constexpr std::uint32_t no_region = 0xffffffff;

/// One region of the opening forest labelling.
struct Region {
  std::uint64_t voxels = 0;
  std::uint16_t opening = 0;  ///< of its root: the radius of its largest balls, in voxels
  std::uint32_t root = 0;     ///< index of the first voxel of its root
};

/// The opening forest labelling (Noel 2015, 10.3.3): regions 0 .. n - 1, numbered by the first
/// voxel of their roots.
struct RegionLabels {
  Grid3<std::uint32_t> label;    ///< the region of every voxel, or no_region
  Grid3<std::uint16_t> opening;  ///< the opening map that they come from
  std::vector<Region> regions;
  std::uint64_t pieces_joined = 0;  ///< see join_stray_pieces()
};

/// Labels every voxel by the root of its tree; roots of equal opening that share faces are one
/// region (def. 10.8, 10.9). Then makes every region 6-connected by join_stray_pieces(). Reuses the
/// memory of the forest for the labels, and temporarily needs runs along x.
RegionLabels forest_labels(OpeningForest forest, const ThreadPool& pool);

}  // namespace lacuna
