#pragma once

#include <Imath/ImathVec.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace lacuna {

/// A skeleton of the empty space as a graph embedded in a grid. Nodes are lattice corners: voxel
/// (i, j, k) spans [i, i+1] x [j, j+1] x [k, k+1]. The graph is symmetric, without loops of one
/// node and without double edges; every list of neighbours ascends.
struct SkeletonGraph {
  std::vector<Imath::V3i> corners;   ///< position of each node, in voxels
  std::vector<float> radii;          ///< Euclidean, in voxels: NodeRadius
  std::vector<std::uint32_t> first;  ///< nodes + 1 offsets into `neighbours`
  std::vector<std::uint32_t> neighbours;

  std::size_t nodes() const { return corners.size(); }
  std::size_t edges() const { return neighbours.size() / 2; }
  std::span<const std::uint32_t> of(std::uint32_t node) const {
    return {neighbours.data() + first[node], neighbours.data() + first[node + 1]};
  }
  std::size_t degree(std::uint32_t node) const { return first[node + 1] - first[node]; }
  /// The radius squared, which is a whole number; exact for radii up to 1448 voxels.
  std::int64_t squared_radius(std::uint32_t node) const {
    const auto r = static_cast<double>(radii[node]);
    return std::llrint(r * r);
  }
  /// Whether a node lies in the closed ball of `centre`.
  bool in_ball(std::uint32_t node, std::uint32_t centre) const {
    const Imath::V3i d = corners[node] - corners[centre];
    return std::int64_t{d.x} * d.x + std::int64_t{d.y} * d.y + std::int64_t{d.z} * d.z <=
           squared_radius(centre);
  }
};

/// The node index for "no node".
inline constexpr std::uint32_t no_node = 0xffffffff;

}  // namespace lacuna
