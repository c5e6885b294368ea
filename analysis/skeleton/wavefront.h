#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <vector>

#include "analysis/complex/plane.h"
#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/grid.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// A breadth-first propagation of labels through a domain over shared faces, all voxels of one
/// distance at a time. A voxel takes the label of a neighbour that was reached one step before, of
/// the first in the order -x, +x, -y, +y, -z, +z.
///
/// Works on bit planes of 8^3 voxels, and only where the front is. The planes store which neighbour
/// that was, 3 bits per voxel; labels are written at the end: because x comes first, then y, most
/// of them are runs along x, and nearly all the rest stays in a plane.
class Wavefront {
 public:
  /// `labels`, as large as the domain and no_node everywhere, receives the labels.
  Wavefront(const BitGrid3& domain, Grid3<std::uint32_t>& labels);

  /// Labels a voxel, at distance 0, unless it lies outside the domain or has a label.
  void start(Imath::V3i voxel, std::uint32_t label);
  /// Propagates until no more voxel can be reached, and labels the reached ones.
  void run(const ThreadPool& pool);
  /// The voxels of the domain that were not reached, by block.
  std::vector<Imath::V3i> unreached() const;

  /// Memory of a front in a grid of that size, bytes.
  static std::uint64_t bytes(Imath::V3i size);

 private:
  struct Block {
    Plane open;  // in the domain, not reached
    /// The neighbour from which a voxel was reached, one bit per plane: 1 to 6 in the order of
    /// preference (1 is -x, 2 is +x), 7 at a start, 0 if it was not reached.
    std::array<BitBlock, 3> from;
  };

  std::size_t index(Imath::V3i voxel) const {
    return static_cast<std::size_t>((voxel.x >> 3) + 1 + stride_[1] * ((voxel.y >> 3) + 1) +
                                    stride_[2] * ((voxel.z >> 3) + 1));
  }
  Imath::V3i corner(std::size_t block) const;
  unsigned from(Imath::V3i voxel) const;
  std::atomic_ref<std::uint32_t> label_at(Imath::V3i voxel) {
    return std::atomic_ref(labels_(voxel));
  }
  void find_candidates();
  bool step(std::size_t block);
  void trace(Imath::V3i voxel, std::vector<Imath::V3i>& way);
  void label_across_planes(int slice);
  void label_plane(int z);
  void label_row(int y, int z);

  Grid3<std::uint32_t>& labels_;
  // Blocks are surrounded by a ring of empty ones.
  Imath::V3i ringed_;
  std::array<std::ptrdiff_t, 3> stride_;
  std::vector<Block> blocks_;
  std::vector<Plane> front_;  // reached by the step before
  std::vector<Plane> next_;   // reached by this step
  std::vector<std::uint32_t> active_, candidates_;
  std::vector<std::uint32_t> asked_;  // the step in which a block was last a candidate
  std::uint32_t steps_ = 0;
};

}  // namespace lacuna
