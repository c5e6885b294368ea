#pragma once

#include <span>
#include <vector>

#include "analysis/octree/octree.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// A place that the scene is seen from, and what of it: all directions in front of a plane, or all.
struct View {
  V3f x;
  V3f n;  ///< unit; 0: sees in all directions
};

/// Views by place (Kol et al. 2018, 3.1.2). Leaves are cubes that hold one view or several, which
/// share what they see.
class ViewTree {
 public:
  /// What the views below a node have in common.
  struct Node {
    V3f centre;    ///< of the sphere around them
    float radius;  ///< of it; 0 for a single view
    V3f n;         ///< the middle of their directions, unit
    /// Cosine and sine of the widest angle between n and a direction that one of them sees: a
    /// right angle more than their normals' cone. cosine -1: they see everything.
    float cosine, sine;
  };

  /// `levels` in [0, Octree::most_levels]: of the octree of the cube at `corner` with `side`, in
  /// which all views lie.
  ViewTree(std::span<const View> views, int levels, V3d corner, double side);

  const Octree& tree() const { return tree_; }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  std::uint32_t leaf_count() const { return static_cast<std::uint32_t>(tree_.leaves().size()); }
  /// The index of the first leaf in tree().nodes.
  std::uint32_t first_leaf() const { return tree_.first[tree_.first.size() - 2]; }
  /// Which leaf, in [0, leaf_count()), view `i` belongs to.
  std::uint32_t leaf_of(std::size_t view) const { return leaf_of_[view]; }

 private:
  Octree tree_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_;
};

}  // namespace lacuna
