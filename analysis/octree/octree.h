#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "analysis/geometry/grid.h"

namespace lacuna {

/// A sparse voxel octree (Kol et al. 2018, 3.1): only occupied cubes have a node.
struct Octree {
  static constexpr int most_levels = 12;  ///< below the root; the limit of TriangleBox's precision

  struct Node {
    Imath::V3f centre;              ///< of its cube, scene units
    std::uint32_t first_child = 0;  ///< the other children follow it
    std::uint8_t octants = 0;       ///< bit i: there is a child in octant i (x + 2 y + 4 z)
    std::uint8_t children = 0;      ///< number of children; 0: a leaf
    std::uint8_t level = 0;         ///< of the root 0
  };

  std::vector<Node> nodes;           ///< the root, then level by level, each along the Morton curve
  std::vector<std::uint32_t> first;  ///< index of the first node of each level, then nodes.size()
  Imath::V3d corner{0.0};            ///< lowest corner of the root's cube, scene units
  double side = 0;                   ///< of the root's cube

  int levels() const { return static_cast<int>(first.size()) - 2; }
  std::span<const Node> leaves() const {
    return {nodes.data() + first[first.size() - 2], nodes.data() + nodes.size()};
  }
  bool empty() const { return nodes.empty(); }
  /// Radius of the bounding sphere of a node's cube.
  float radius(int level) const { return radius(side, level); }
  static float radius(double side, int level) {
    constexpr float half_diagonal = std::numbers::sqrt3_v<float> / 2;  // of a cube of side 1
    return static_cast<float>(side) * half_diagonal / static_cast<float>(1 << level);
  }
};

/// `codes`: Morton codes of the leaves, ascending, each once, at `levels` in [0, most_levels] below
/// a root whose lowest corner is `corner` and whose side is `side`, scene units. Linear time.
Octree build_octree(std::span<const std::uint64_t> codes, int levels, Imath::V3d corner,
                    double side);

}  // namespace lacuna
