#pragma once

#include <cstdint>
#include <vector>

#include "analysis/geometry/grid.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// Evaluates Omega_1 of single voxels (Noel 2015, 6.2.2) without a map: thinning needs it at few
/// voxels only. Stores the largest D_1 of each block of 8^3 and of 64^3 voxels.
class OpeningQuery {
 public:
  /// `l1` is the result of l1_distance(), held by reference; it must outlive the query.
  OpeningQuery(const Grid3<std::uint16_t>& l1, const ThreadPool& pool);

  /// max { D_1(y) : |x - y|_1 < D_1(y) }: the radius of the largest ball in the domain that
  /// contains `voxel`; 0 outside the domain. The voxel must lie in the grid. Thread-safe.
  std::uint16_t operator()(Imath::V3i voxel) const;

  /// Whether that radius is at least `radius` (> 0). Much faster: it skips smaller balls, and the
  /// first one large enough ends the search.
  bool reaches(Imath::V3i voxel, int radius) const;

 private:
  struct Search;
  const Grid3<std::uint16_t>* l1_;
  Grid3<std::uint16_t> blocks_;  // largest D_1 of 8^3 voxels
  Grid3<std::uint16_t> tiles_;   // of 8^3 blocks
};

}  // namespace lacuna
