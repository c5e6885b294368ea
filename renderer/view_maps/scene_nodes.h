#pragma once

#include "analysis/octree/octree.h"
#include "base/parallel/thread_pool.h"
#include "renderer/core/huge_pages.h"
#include "renderer/core/vec.h"
#include "renderer/view_maps/node_list.h"

namespace lacuna {

/// A scene's octree for many-view rendering: eight bytes per node, including the box of the leaves
/// below it. Coordinates are those of a grid whose unit is half the side of a leaf and whose origin
/// is the lowest corner of the root; centres of cubes are integers.
class SceneNodes {
 public:
  struct Node {
    std::uint32_t first_child;  ///< the other children follow contiguously
    /// Bits 0-7: Octree::Node::octants. Then four bits for each of x from, x to, y from, y to, z
    /// from, z to: the first and the last sixteenth of the cube that leaves below it overlap.
    std::uint32_t shape;
  };

  SceneNodes(const Octree& scene, const ThreadPool& pool);

  int levels() const { return levels_; }
  bool empty() const { return leaves_ == 0; }
  std::size_t leaf_count() const { return leaves_; }
  /// Half the side of a node's cube, in grid units.
  float half_side(int level) const { return static_cast<float>(1 << (levels_ - level)); }
  /// Radius of a node's bounding sphere, in grid units.
  float radius(int level) const { return half_side(level) * std::numbers::sqrt3_v<float>; }
  double unit() const { return unit_; }  ///< of the grid, scene units
  V3f to_grid(const V3f& x) const { return V3f((V3d(x) - corner_) / unit_); }

  /// Appends the root.
  void append_root(NodeList& to) const;
  /// Appends the children of all nodes of `from`, which have this level.
  void append_children(const NodeList& from, int level, NodeList& to) const;
  std::uint32_t shape(std::uint32_t node) const { return nodes_[node].shape; }

 private:
  HugeVector<Node> nodes_;  // level by level, then eight empty nodes
  V3d corner_;
  double unit_;
  int levels_;
  std::size_t leaves_;
};

}  // namespace lacuna
