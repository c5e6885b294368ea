#pragma once

#include <span>
#include <vector>

#include "analysis/octree/octree.h"
#include "renderer/core/vec.h"

namespace lacuna {

/// A viewpoint and its field of view: the half space in front of a plane, or all directions.
struct View {
  V3f x;
  V3f n;  ///< unit normal of the plane; 0: all directions
};

/// An octree of views (Kol et al. 2018, 3.1.2). A leaf is a cube with one or several views, which
/// share a map.
///
/// With `Split::facing` (not in the paper), nodes of level `facing_level` are divided by the facing
/// of their views before they are divided into smaller cubes: by the axis and sign of the normal's
/// largest coordinate. This separates the two sides of a thin wall, or the walls of a corner: in
/// one node, their cone of normals would cull little. tree() has one more level, and its cubes are
/// not those of the views.
class ViewTree {
 public:
  enum class Split { position, facing };
  /// Measured on sponza with a million lights: at higher levels, fewer views share a splat (by up
  /// to a quarter); at level 8, pairs increase by up to 4 %, and below the smallest cubes by 14 to
  /// 24 %.
  static constexpr int facing_level = 6;

  /// Bounds of the views below a node.
  struct Node {
    V3f centre;    ///< of their bounding sphere
    float radius;  ///< of their bounding sphere; 0 for a single view
    V3f half;      ///< half the size of their bounding box, which has the same centre
    V3f n;         ///< axis of the cone around their normals, unit
    /// Cosine and sine of the largest angle between n and a direction visible from one of the
    /// views: the half angle of the normals' cone plus a right angle. cosine -1: all directions.
    float cosine, sine;
    std::uint32_t views;  ///< number of views
  };

  /// `levels` in [0, Octree::most_levels): of cubes. The cube at `corner` with `side` must contain
  /// all views.
  ViewTree(std::span<const View> views, int levels, V3d corner, double side,
           Split split = Split::facing);
  /// A tree of leaves only, one per view, in the order of `views`.
  static ViewTree of_single_views(std::span<const View> views);

  const Octree& tree() const { return tree_; }
  const Node& node(std::uint32_t i) const { return nodes_[i]; }
  std::uint32_t leaf_count() const { return static_cast<std::uint32_t>(tree_.leaves().size()); }
  /// Index of the first leaf in tree().nodes.
  std::uint32_t first_leaf() const { return tree_.first[tree_.first.size() - 2]; }
  /// The leaf, in [0, leaf_count()), of a view.
  std::uint32_t leaf_of(std::size_t view) const { return leaf_of_[view]; }

 private:
  ViewTree() = default;
  void bound(std::span<const View> views);

  Octree tree_;
  std::vector<Node> nodes_;
  std::vector<std::uint32_t> leaf_of_;
};

}  // namespace lacuna
