#pragma once

#include "analysis/geometry/triangle_soup.h"
#include "analysis/octree/octree.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The cube of a scene's octree: contains the bounding box of all triangles with a margin. For a
/// fractional `levels` it is larger, such that 2^levels leaves span the box.
struct OctreeCube {
  Imath::V3d corner{0.0};
  double side = 1;
  int levels = 0;  ///< of the octree, below the root
};
/// `levels` in [0, Octree::most_levels].
OctreeCube octree_cube(const TriangleSoup& soup, double levels);
/// The cube for a bounding box.
OctreeCube octree_cube(const Imath::V3d& low, const Imath::V3d& high, double levels);

/// The octree of a scene's surfaces: a cube is a leaf if and only if its closure meets a triangle,
/// like the voxels of voxelize(), but without a dense grid. `levels` in [0, Octree::most_levels].
/// The same for any number of threads. Throws MemoryLimitError if it would take more than
/// `byte_limit` bytes.
Octree surface_octree(const TriangleSoup& soup, double levels, const ThreadPool& pool,
                      std::uint64_t byte_limit);

}  // namespace lacuna
