#include "analysis/skeleton/build_graph.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "analysis/skeleton/adjacency.h"
#include "analysis/skeleton/ball_radius.h"
#include "analysis/space/sweep.h"

namespace lacuna {
namespace {

/// The vertices of a complex, numbered by their cells: x fastest, then y, then z.
class Vertices {
 public:
  Vertices(const CubicalComplex& complex, const ThreadPool& pool);

  const std::vector<Imath::V3i>& cells() const { return cells_; }
  /// The number of the vertex at a cell, which must contain one.
  std::uint32_t at(Imath::V3i cell) const {
    const std::size_t block =
        complex_.index((cell.x >> 3) + 1, (cell.y >> 3) + 1, (cell.z >> 3) + 1);
    const BitBlock bits = complex_.data()[block].faces[0].bits();
    const auto lane = static_cast<std::size_t>(cell.z & 7);
    const int bit = (cell.y & 7) * 8 + (cell.x & 7);
    auto rank =
        static_cast<std::size_t>(std::popcount(bits.z[lane] & ((std::uint64_t{1} << bit) - 1)));
    for (std::size_t z = 0; z < lane; ++z)
      rank += static_cast<std::size_t>(std::popcount(bits.z[z]));
    return number_[first_[block] + rank];
  }

 private:
  const CubicalComplex& complex_;
  std::vector<std::uint32_t> first_;   // of each block, in the order of blocks and their bits
  std::vector<std::uint32_t> number_;  // of each vertex in that order
  std::vector<Imath::V3i> cells_;
};

Vertices::Vertices(const CubicalComplex& complex, const ThreadPool& pool)
    : complex_(complex), first_(complex.block_count() + 1) {
  const int layers = complex.blocks().z;
  const auto layer = static_cast<std::size_t>(complex.stride(2));
  std::vector<char> has_surface(static_cast<std::size_t>(layers), 0);
  run_parallel(pool, layers, [&](int bz) {
    const std::size_t from = layer * static_cast<std::size_t>(bz);
    Plane surface = Plane::zero();
    for (std::size_t b = from; b < from + layer; ++b) {
      const auto& faces = complex.data()[b].faces;
      first_[b + 1] = static_cast<std::uint32_t>(faces[0].bits().count());
      surface |= faces[3] | faces[5] | faces[6] | faces[7];
    }
    has_surface[static_cast<std::size_t>(bz)] = surface.any();
  });
  if (std::find(has_surface.begin(), has_surface.end(), 1) != has_surface.end())
    throw std::invalid_argument(fmt::format(
        "the skeleton holds {} squares and {} cubes: a graph has vertices and edges only",
        complex.count(2), complex.count(3)));

  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  std::vector<Imath::V3i> by_block(first_.back());
  run_parallel(pool, layers, [&](int bz) {
    const std::size_t from = layer * static_cast<std::size_t>(bz);
    for (std::size_t b = from; b < from + layer; ++b) {
      if (first_[b] == first_[b + 1]) continue;
      std::uint32_t next = first_[b];
      for_each_bit(complex.data()[b].faces[0],
                   [&](int position) { by_block[next++] = complex.corner(b) + cell_of(position); });
    }
  });
  std::vector<std::uint32_t> order(by_block.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Imath::V3i &a = by_block[i], &b = by_block[j];
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
  });
  number_.resize(order.size());
  cells_.resize(order.size());
  for (std::uint32_t n = 0; n < order.size(); ++n) {
    number_[order[n]] = n;
    cells_[n] = by_block[order[n]];
  }
}

/// The graph without radii. `distances`: the size of the grid that they will be read from.
SkeletonGraph nodes_and_edges(const CubicalComplex& skeleton, Imath::V3i distances,
                              const ThreadPool& pool) {
  if (skeleton.size() != distances)
    throw std::invalid_argument(
        fmt::format("a skeleton in a grid of {} x {} x {} voxels, distances in one of {} x {} x {}",
                    skeleton.size().x, skeleton.size().y, skeleton.size().z, distances.x,
                    distances.y, distances.z));
  const Vertices vertices(skeleton, pool);
  SkeletonGraph graph;
  graph.corners = vertices.cells();
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(graph.nodes());
  for (std::uint32_t n = 0; n < graph.nodes(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (skeleton.has(graph.corners[n], 1 << axis)) {
        Imath::V3i end = graph.corners[n];
        ++end[axis];
        edges.push_back({n, vertices.at(end)});
      }
  set_edges(graph, edges);
  return graph;
}

float radius(std::int64_t square) {
  return static_cast<float>(std::sqrt(static_cast<double>(square)));
}

}  // namespace

SkeletonGraph build_graph(const CubicalComplex& skeleton, const Grid3<std::uint16_t>& l1,
                          const ThreadPool& pool) {
  SkeletonGraph graph = nodes_and_edges(skeleton, l1.size(), pool);
  for (const std::int64_t square : squared_ball_radii(l1, graph.corners, pool))
    graph.radii.push_back(radius(square));
  return graph;
}

SkeletonGraph build_graph_by_voxels(const CubicalComplex& skeleton,
                                    const Grid3<std::uint32_t>& squares, const ThreadPool& pool) {
  SkeletonGraph graph = nodes_and_edges(skeleton, squares.size(), pool);
  for (const Imath::V3i& corner : graph.corners)
    graph.radii.push_back(radius(squared_voxel_radius(squares, corner)));
  return graph;
}

}  // namespace lacuna
