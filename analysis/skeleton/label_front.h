#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "analysis/complex/plane.h"
#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/grid.h"
#include "analysis/parallel/thread_pool.h"

namespace lacuna {

/// A front that walks through a domain over shared faces, all voxels of one distance at a time, and
/// hands labels on: a voxel takes the smallest label among its neighbours that were reached one
/// step before. Works on blocks of 8^3 voxels, and only on those that the front is in; each block
/// has one thread for a whole step.
class LabelFront {
 public:
  /// `labels`, as large as the domain and no_node everywhere, receives the labels.
  LabelFront(const BitGrid3& domain, Grid3<std::uint32_t>& labels);

  /// Gives a voxel its label, at distance 0; nothing if it is not in the domain or has one.
  void start(Imath::V3i voxel, std::uint32_t label);
  /// Walks until nothing more can be reached.
  void run(const ThreadPool& pool);
  /// The voxels of the domain that have no label, by block.
  std::vector<Imath::V3i> unreached() const;

  /// Bytes that a front takes for a grid of that size.
  static std::uint64_t bytes(Imath::V3i size);

 private:
  std::size_t index(Imath::V3i voxel) const {
    return static_cast<std::size_t>((voxel.x >> 3) + 1 + stride_[1] * ((voxel.y >> 3) + 1) +
                                    stride_[2] * ((voxel.z >> 3) + 1));
  }
  Imath::V3i corner(std::size_t block) const;
  void find_candidates();
  bool step(std::size_t block);
  void hand_on(std::size_t block, const std::array<Plane, 6>& from, const Plane& next);

  Grid3<std::uint32_t>& labels_;
  // Blocks lie in a ring of empty ones.
  Imath::V3i blocks_;
  std::array<std::ptrdiff_t, 3> stride_;
  std::vector<Plane> open_;   // in the domain, without label
  std::vector<Plane> front_;  // reached by the step before
  std::vector<Plane> next_;   // reached by this step
  std::vector<std::uint32_t> active_, candidates_;
  std::vector<std::uint32_t> asked_;  // the step in which a block was last a candidate
  std::uint32_t steps_ = 0;
};

}  // namespace lacuna
