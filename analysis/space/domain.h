#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/grid.h"
#include "analysis/space/voxelize.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// A point that emits or receives light: a camera, or a point of a light with the normal of the
/// emitting side (a light that emits on both sides has two seeds).
struct Seed {
  Imath::V3d position;               ///< scene units
  std::optional<Imath::V3d> normal;  ///< any length but 0
};

/// The seeds that select the relevant part of the empty space.
struct DomainSeeds {
  std::vector<Seed> points;
  bool from_infinity = false;  ///< there is an environment or a directional light
};

/// The part of the empty space that light can reach.
struct Domain {
  BitGrid3 voxels;                                            ///< 1: in the domain
  std::uint64_t components_kept = 0, components_dropped = 0;  ///< 26-components of empty voxels
  std::uint64_t voxels_kept = 0, voxels_dropped = 0;          ///< empty voxels
  std::uint64_t seeds_buried = 0;  ///< points without an empty voxel nearby, which select nothing
};

/// Largest distance, in voxels, from a seed's own voxel to the empty voxel that it selects.
inline constexpr int seed_reach = 8;

/// Keeps the 26-components of the empty voxels (their cubical complex is connected through shared
/// corners) that a seed selects:
/// - A seed in an empty voxel selects the component of this voxel.
/// - A seed with a normal in a scene voxel takes the empty voxel v of the nearest cubic shell
///   around its own voxel s that has one on the normal's side, by the largest (v - s) . normal
///   (Noel 2015, eq. 154), the first in memory among equals. The outside of the grid is empty, too.
/// - A seed without a normal in a scene voxel selects all components that intersect the nearest
///   shell with an empty voxel, on any side.
/// - A seed outside the grid, and light from infinity, selects every component that touches the
///   grid's border.
/// Without seeds nothing is kept. Throws std::invalid_argument on a seed that is not finite or has
/// a normal of length 0, MemoryLimitError if it would take more than `byte_limit` bytes.
Domain restrict_domain(const Voxels& voxels, const DomainSeeds& seeds, const ThreadPool& pool,
                       std::uint64_t byte_limit);

/// All empty voxels: the complement of `scene`.
BitGrid3 empty_voxels(const BitGrid3& scene);

}  // namespace lacuna
