#pragma once

#include <atomic>
#include <functional>
#include <mutex>

#include "analysis/complex/collapse.h"
#include "analysis/geometry/grid.h"

namespace lacuna {

/// The maps of the empty space that the rule uses.
struct SpaceMaps {
  /// Distance of every voxel to the scene (0 there), L1 as in the thesis.
  const Grid3<std::uint16_t>& distance;
  /// opening_reaches(voxel, radius), radius > 0: whether some ball of at least that radius, in that
  /// distance, lies in the empty space and contains the voxel: Omega(voxel) >= radius. Thread-safe.
  std::function<bool(Imath::V3i, int)> opening_reaches;
};

/// Finds the edges that a curvilinear skeleton must keep (line 1 of thesis Alg. 3) by observing an
/// unconstrained collapse: those with
///
///     Lifespan > decenterness + Birth - D
///
/// and those that never die. Dates are stored only for edges that stay facets for a whole layer:
/// for all others Birth = Death, and every edge has Birth >= D in the closure of its voxels. Edges
/// of closed surfaces, which are never born, are not kept; otherwise piercing would free nothing.
class KeepRule final : public LayerObserver {
 public:
  /// Memory per block, without the dates, which are few.
  static constexpr std::uint64_t bytes_per_block =
      sizeof(std::array<Plane, 3>) + sizeof(std::vector<int>);

  /// All three must outlive it.
  KeepRule(const CubicalComplex& complex, const SpaceMaps& maps, KeptEdges& kept);

  void edges(int date, std::size_t block, const std::array<Plane, 3>& present,
             const std::array<Plane, 3>& facets) override;
  /// Call after the last layer: edges that were born and are still present never die.
  void finish();
  /// Number of calls of opening_reaches.
  std::size_t openings_asked() const { return openings_asked_; }

 private:
  struct Birth {
    std::uint16_t edge;  // position in the block + 512 * axis
    std::uint32_t date;
  };
  bool is_kept(std::size_t block, int axis, int position);
  int take_birth(std::size_t block, std::uint16_t edge);
  bool holds(Imath::V3i cell, int axis, int birth, int death);

  const CubicalComplex& complex_;
  const SpaceMaps& maps_;
  KeptEdges& kept_;
  std::vector<std::array<Plane, 3>> alive_;  // edges that are facets, by block and axis
  std::vector<std::vector<Birth>> births_;   // of these
  std::atomic<std::size_t> openings_asked_ = 0;
  std::mutex keeping_;  // guards kept_
};

}  // namespace lacuna
