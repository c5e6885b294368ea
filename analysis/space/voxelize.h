#pragma once

#include <cstdint>
#include <stdexcept>

#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/grid.h"
#include "analysis/geometry/triangle_soup.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The triangles cannot be voxelised: there are none, or their coordinates are not finite or span
/// too little.
class GeometryError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The grid that voxelize() will fill.
struct GridPlan {
  Imath::V3i size{0};       ///< voxels, each side at least 1
  GridTransform transform;  ///< its origin is the corner of the triangles' bounding box
  std::uint64_t bytes = 0;  ///< estimated memory of voxelisation: the grid and its lists
};

/// Covers the bounding box of all triangles with cubic voxels. `resolution`: voxels along its
/// longest side, in [1, max_resolution], else std::invalid_argument. If all triangles lie in one
/// point, the grid is one voxel of side 1 around it. Throws GeometryError. Allocates nothing.
GridPlan plan_grid(const TriangleSoup& soup, int resolution);

/// The digital scene (Noel 2015, 6.1.2): a bit for every voxel that contains surface.
struct Voxels {
  GridTransform transform;
  BitGrid3 scene;
};

/// Conservative: every voxel of the grid whose closed cube intersects a closed triangle is scene,
/// also where the triangle is a segment or a point, so no 26-path of empty voxels crosses a closed
/// wall. A voxel whose cube misses a triangle by less than about 1e-8 of its side may be scene,
/// too. The same bits for any number of threads. Throws as plan_grid(), and MemoryLimitError if it
/// would take more than `byte_limit` bytes.
Voxels voxelize(const TriangleSoup& soup, int resolution, const ThreadPool& pool,
                std::uint64_t byte_limit);

}  // namespace lacuna
