#include "analysis/artefacts/codec.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

constexpr int largest_side = 1 << 16;

bool is_symmetric(const SkeletonGraph& graph) {
  for (std::uint32_t node = 0; node < graph.nodes(); ++node) {
    for (const std::uint32_t other : graph.of(node)) {
      const auto back = graph.of(other);
      if (!std::binary_search(back.begin(), back.end(), node)) return false;
    }
  }
  return true;
}

/// Checks the invariants of SkeletonGraph.
void check_graph(const SkeletonGraph& graph) {
  const std::size_t nodes = graph.nodes();
  require(graph.radii.size() == nodes, "a graph needs a radius for each node");
  require(std::all_of(graph.radii.begin(), graph.radii.end(),
                      [](float r) { return std::isfinite(r) && r >= 0; }),
          "a graph's radii are finite and at least 0");
  if (nodes == 0 && graph.first.empty()) {
    require(graph.neighbours.empty(), "a graph without nodes has no edges");
    return;
  }
  require(graph.first.size() == nodes + 1 && graph.first.front() == 0 &&
              graph.first.back() == graph.neighbours.size() &&
              std::is_sorted(graph.first.begin(), graph.first.end()),
          "a graph's lists of neighbours are consecutive");
  for (std::uint32_t node = 0; node < nodes; ++node) {
    const auto list = graph.of(node);
    for (std::size_t i = 0; i < list.size(); ++i) {
      require(list[i] < nodes && list[i] != node && (i == 0 || list[i - 1] < list[i]),
              "a graph's neighbours are other nodes, ascending");
    }
  }
  require(is_symmetric(graph), "a graph is symmetric");
}

/// The bits of one layer of a block in a grid with these numbers of cells left along x and y.
std::uint64_t inside_mask(int x_left, int y_left) {
  std::uint64_t mask = 0;
  const std::uint64_t row = x_left < BitBlock::side ? (std::uint64_t{1} << x_left) - 1 : 0xff;
  for (int y = 0; y < std::min(y_left, BitBlock::side); ++y) mask |= row << (8 * y);
  return mask;
}

/// No bit beyond the grid's size is 1.
bool only_inside(const BitGrid3& grid) {
  const Imath::V3i n = grid.blocks();
  for (int bz = 0; bz < n.z; ++bz) {
    for (int by = 0; by < n.y; ++by) {
      for (int bx = 0; bx < n.x; ++bx) {
        const Imath::V3i left = grid.size() - BitBlock::side * Imath::V3i(bx, by, bz);
        const std::uint64_t mask = inside_mask(left.x, left.y);
        for (int z = 0; z < BitBlock::side; ++z) {
          const std::uint64_t bits = grid.block(bx, by, bz).z[static_cast<std::size_t>(z)];
          if ((bits & ~(z < left.z ? mask : 0)) != 0) return false;
        }
      }
    }
  }
  return true;
}

}  // namespace

Imath::V3i read_grid_size(ArtefactReader& in, int side, std::size_t bytes) {
  const auto size = decode<Imath::V3i>(in);
  std::uint64_t units = 1;  // at most 2^48
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] < 0 || size[axis] > largest_side) {
      throw std::runtime_error(
          fmt::format("a grid's side: found {}; allowed: 0 to {}", size[axis], largest_side));
    }
    units *= static_cast<std::uint64_t>((size[axis] + side - 1) / side);
  }
  require(units <= in.remaining() / bytes, "a grid is larger than its bytes");
  return size;
}

void Codec<BitGrid3>::write(ArtefactWriter& out, const BitGrid3& grid) {
  encode(out, grid.size());
  out.append(grid.data().data(), sizeof(BitBlock) * grid.data().size());
}

BitGrid3 Codec<BitGrid3>::read(ArtefactReader& in) {
  BitGrid3 grid(read_grid_size(in, BitBlock::side, sizeof(BitBlock)));
  in.read(grid.data().data(), sizeof(BitBlock) * grid.data().size());
  // count() relies on it.
  require(only_inside(grid), "a grid's bits beyond its size are 0");
  return grid;
}

void Codec<GridTransform>::write(ArtefactWriter& out, const GridTransform& transform) {
  encode(out, transform.origin, transform.voxel_size);
}

GridTransform Codec<GridTransform>::read(ArtefactReader& in) {
  GridTransform transform;
  transform.origin = decode<Imath::V3d>(in);
  transform.voxel_size = decode<double>(in);
  require(std::isfinite(transform.origin.x) && std::isfinite(transform.origin.y) &&
              std::isfinite(transform.origin.z),
          "a grid's origin is finite");
  require(std::isfinite(transform.voxel_size) && transform.voxel_size > 0,
          "a voxel's size is finite and above 0");
  return transform;
}

void Codec<SkeletonGraph>::write(ArtefactWriter& out, const SkeletonGraph& graph) {
  encode(out, graph.corners, graph.radii, graph.first, graph.neighbours);
}

SkeletonGraph Codec<SkeletonGraph>::read(ArtefactReader& in) {
  SkeletonGraph graph;
  graph.corners = decode<std::vector<Imath::V3i>>(in);
  graph.radii = decode<std::vector<float>>(in);
  graph.first = decode<std::vector<std::uint32_t>>(in);
  graph.neighbours = decode<std::vector<std::uint32_t>>(in);
  check_graph(graph);
  return graph;
}

}  // namespace lacuna
