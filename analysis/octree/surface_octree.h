#pragma once

#include "analysis/geometry/triangle_soup.h"
#include "analysis/octree/octree.h"
#include "analysis/parallel/thread_pool.h"

namespace lacuna {

/// The cube that a scene's octree fills: around the box of all triangles, with room to spare.
struct OctreeCube {
  Imath::V3d corner{0.0};
  double side = 1;
};
OctreeCube octree_cube(const TriangleSoup& soup);
/// The same of their box.
OctreeCube octree_cube(const Imath::V3d& low, const Imath::V3d& high);

/// Every leaf's closed cube meets a triangle, and every cube that does is a leaf: the voxels of
/// voxelize(), but never as a dense grid. `levels` in [0, Octree::most_levels]. The same for any
/// number of threads. Throws MemoryLimitError if it would take more than `byte_limit` bytes.
Octree surface_octree(const TriangleSoup& soup, int levels, const ThreadPool& pool,
                      std::uint64_t byte_limit);

}  // namespace lacuna
