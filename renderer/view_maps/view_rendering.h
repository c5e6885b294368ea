#pragma once

#include <array>
#include <vector>

#include "renderer/view_maps/paraboloid.h"
#include "renderer/view_maps/view_tree.h"

namespace lacuna {

/// Counts of a traversal.
struct ManyViewsCounts {
  std::uint64_t pairs = 0;    ///< processed pairs of a scene node and a view node
  std::uint64_t culled = 0;   ///< pairs that were culled
  std::uint64_t splats = 0;   ///< scene nodes that were rendered
  std::uint64_t large = 0;    ///< splats of leaves that may fill several texels
  std::uint64_t sharing = 0;  ///< view leaves that share a splat, summed over splats
  /// Pairs by the number of subdivisions that led to them.
  std::array<std::uint64_t, 2 * Octree::most_levels + 1> generations{};
  /// Of a breadth-first traversal: the largest size of its queue and of its maps of view nodes, and
  /// the CPU time of copying the maps down.
  std::uint64_t queue_bytes = 0, unfused_bytes = 0;
  double fusion_seconds = 0;

  /// Largest number of pairs in a breadth-first queue, which holds one generation at a time.
  std::uint64_t queue_peak() const {
    return *std::max_element(generations.begin(), generations.end());
  }
  ManyViewsCounts& operator+=(const ManyViewsCounts& o);
};

/// How the scene is rendered into many views.
struct ManyViewsSettings {
  int map_size = 16;  ///< texels along a side of each paraboloid
  /// Largest diameter, in texels, of a node's sphere that is rendered as one texel, > 0; 1 in the
  /// paper. The image of a leaf's cube is as wide as its sphere's over sqrt(3).
  float node_texels = 1;
  /// In [0, 1]: a node fills the texels whose centres lie within this share of its sphere's radius;
  /// 0: the texel that contains its own centre, as in the paper.
  float cover = 0;
  bool share = true;  ///< false: every view leaf by itself, ManyLoDs (Hollaender et al. 2011)
  bool merge = true;  ///< false: every leaf is rendered, no inner node
  bool cull = true;
  bool breadth_first = false;  ///< use a queue, as in the paper; the same maps
};

/// Some children of a node of the scene's octree.
struct Siblings {
  std::uint32_t parent;  ///< no_parent: the root alone
  std::uint8_t octants;

  static constexpr std::uint32_t no_parent = ~std::uint32_t{0};
  static constexpr Siblings root() { return {no_parent, 1}; }
  static constexpr Siblings all_of(std::uint32_t parent) { return {parent, 0xff}; }
};

/// Renders nodes of a scene into the map of one view node at a time (Kol et al. 2018, 3.2). Works
/// on eight siblings at once, which have the same level and size.
class ViewRendering {
 public:
  /// The references outlive it.
  ViewRendering(const Octree& scene, const ViewTree& views, const ManyViewsSettings& settings);

  /// Whether there is nothing to render.
  bool scene_empty() const { return scene_.empty(); }
  /// Length of a map in floats: its texels, rounded up to whole vectors of eight.
  std::size_t map_floats() const { return x_.size(); }
  std::size_t texels() const { return static_cast<std::size_t>(map_.texels()); }
  bool is_leaf(std::uint32_t view) const { return views_.tree().nodes[view].children == 0; }

  /// Nodes of the scene that a view node leaves undecided.
  struct Undecided {
    std::vector<Siblings> here;   ///< to be subdivided for this view node
    std::vector<Siblings> later;  ///< to be decided by the views below it
  };
  /// Renders the scene nodes `waiting`, with all nodes below them, into the map of a view node;
  /// `left.here` ends empty. Adds the nodes that its children must decide to `left.later`.
  void render(std::uint32_t view, std::span<const Siblings> waiting, std::span<float> depths,
              Undecided& left, ManyViewsCounts& counts) const;
  /// render() without the nodes below `waiting`.
  void render_once(std::uint32_t view, std::span<const Siblings> waiting, std::span<float> depths,
                   Undecided& left, ManyViewsCounts& counts) const;

  /// Copies the map of `parent` to its `child` (3.2.5): distances to the same points from the
  /// child's own centre, in the same texels. Both spans have map_floats() elements.
  void hand_down(std::uint32_t parent, std::span<const float> from, std::uint32_t child,
                 std::span<float> to) const;

 private:
  struct Eight;
  struct LevelSize {
    float radius, half_side;  // of the spheres and of the cubes
  };
  struct Visit;  // of a view node
  Visit visit(std::uint32_t view, std::span<float> depths, Undecided& left) const;
  void look(const Siblings& siblings, Visit& visit) const;
  Eight eight(const Siblings& s, const ViewTree::Node& v) const;
  void fill(const Eight& e, unsigned lanes, std::span<float> depths) const;

  const Octree& scene_;
  const ViewTree& views_;
  ManyViewsSettings settings_;
  Paraboloid map_;
  std::vector<LevelSize> sizes_;      // of the scene's levels
  std::vector<float> x_, y_, z_;      // of the directions of the texels
  std::vector<std::uint32_t> below_;  // of each view node, its leaves
};

}  // namespace lacuna
