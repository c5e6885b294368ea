#pragma once

#include <cstdint>

#include "analysis/complex/cubical_complex.h"
#include "analysis/geometry/grid.h"
#include "analysis/skeleton/graph.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The graph of a complex of vertices and edges (Noel 2015, 6.2.5), such as the result of
/// curvilinear_skeleton(): a node for each vertex, x fastest, then y, then z. Radii are Euclidean,
/// in voxels, from the corner to the nearest closed cube outside the domain or the grid
/// (squared_ball_radius()). `l1` is l1_distance() of the domain. Throws std::invalid_argument if
/// the complex contains squares or cubes, or differs from `l1` in size.
SkeletonGraph build_graph(const CubicalComplex& skeleton, const Grid3<std::uint16_t>& l1,
                          const ThreadPool& pool);

/// The same graph with the radii of squared_voxel_radius(), which are at least 1:
/// NodeRadius::voxel and chessboard. `squares` is squared_distance() of the domain, or the squares
/// of chebyshev_distance().
SkeletonGraph build_graph_by_voxels(const CubicalComplex& skeleton,
                                    const Grid3<std::uint32_t>& squares, const ThreadPool& pool);

}  // namespace lacuna
