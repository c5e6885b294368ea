#pragma once

#include <array>
#include <vector>

#include "renderer/view_maps/paraboloid.h"
#include "renderer/view_maps/view_tree.h"

namespace lacuna {

/// What a traversal did.
struct ManyViewsCounts {
  std::uint64_t pairs = 0;    ///< of a scene node and a view node that were looked at
  std::uint64_t culled = 0;   ///< of those
  std::uint64_t splats = 0;   ///< scene nodes that were rendered
  std::uint64_t large = 0;    ///< of those, leaves that may fill several texels
  std::uint64_t sharing = 0;  ///< view leaves below, summed over splats
  /// Pairs by the number of subdivisions that led to them.
  std::array<std::uint64_t, 2 * Octree::most_levels + 1> generations{};
  /// Of a breadth-first traversal: what its queue and its maps of view nodes took at most, and the
  /// CPU time of handing these down.
  std::uint64_t queue_bytes = 0, unfused_bytes = 0;
  double fusion_seconds = 0;

  /// Pairs that a breadth-first queue, in which a generation lies at a time, would hold.
  std::uint64_t queue_peak() const {
    return *std::max_element(generations.begin(), generations.end());
  }
  ManyViewsCounts& operator+=(const ManyViewsCounts& o);
};

/// How the scene is rendered into many views.
struct ManyViewsSettings {
  int map_size = 16;  ///< texels along a side of each paraboloid
  /// What a node's sphere may show across, at most, to be rendered as one texel, > 0; 1 in the
  /// paper. A leaf's cube shows as much as its sphere over sqrt(3).
  float node_texels = 1;
  /// In [0, 1]: a node fills the texels whose middles lie within this share of its sphere's radius;
  /// 0: the texel that its own middle falls into, as in the paper.
  float cover = 0;
  bool share = true;  ///< false: every view leaf by itself, ManyLoDs (Hollaender et al. 2011)
  bool merge = true;  ///< false: no node stands for the leaves below it
  bool cull = true;
  bool breadth_first = false;  ///< by a queue, as in the paper; the same maps
};

/// Some children of a node of the scene's octree.
struct Siblings {
  std::uint32_t parent;  ///< `no_parent`: of the root alone
  std::uint8_t octants;

  static constexpr std::uint32_t no_parent = ~std::uint32_t{0};
  static constexpr Siblings root() { return {no_parent, 1}; }
  static constexpr Siblings all_of(std::uint32_t parent) { return {parent, 0xff}; }
};

/// Renders nodes of a scene into the map of one view node at a time (Kol et al. 2018, 3.2): eight
/// siblings at once, whose level and so whose size is the same.
class ViewRendering {
 public:
  /// The references outlive it.
  ViewRendering(const Octree& scene, const ViewTree& views, const ManyViewsSettings& settings);

  /// Floats that a map takes: its texels, and room to work on eight at a time.
  std::size_t map_floats() const { return x_.size(); }
  std::size_t texels() const { return static_cast<std::size_t>(map_.texels()); }
  bool is_leaf(std::uint32_t view) const { return views_.tree().nodes[view].children == 0; }

  /// Nodes of the scene that a view node leaves undecided.
  struct Undecided {
    std::vector<Siblings> here;   ///< for itself: their children are to be looked at
    std::vector<Siblings> later;  ///< for the views below it
  };
  /// Renders what waits for a view node into its map, with all that lies below it: nothing stays
  /// `left.here`. What its children must decide is added to `left.later`.
  void render(std::uint32_t view, std::span<const Siblings> waiting, std::span<float> depths,
              Undecided& left, ManyViewsCounts& counts) const;
  /// The same of what waits, without what lies below it.
  void render_once(std::uint32_t view, std::span<const Siblings> waiting, std::span<float> depths,
                   Undecided& left, ManyViewsCounts& counts) const;

  /// What a child has of its parent's map (3.2.5): distances to the same places from its own
  /// centre, and so in the same texels. Both span map_floats().
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
