#pragma once

#include <array>
#include <optional>
#include <vector>

#include "renderer/view_maps/mip_splats.h"
#include "renderer/view_maps/scene_nodes.h"
#include "renderer/view_maps/view_tree.h"

namespace lacuna {

/// Counts of a traversal.
struct ManyViewsCounts {
  std::uint64_t pairs = 0;    ///< processed pairs of a scene node and a view node
  std::uint64_t culled = 0;   ///< pairs that were culled
  std::uint64_t splats = 0;   ///< rendered scene nodes
  std::uint64_t large = 0;    ///< splats of leaves that may cover several texels
  std::uint64_t shared = 0;   ///< of `large`, those in maps of several views
  std::uint64_t filled = 0;   ///< texels that were looked at to draw `large`
  std::uint64_t sharing = 0;  ///< single views that share a splat, summed over splats
  /// Number of pairs by the number of preceding subdivisions.
  std::array<std::uint64_t, 2 * Octree::most_levels + 1> generations{};
  /// Breadth-first traversal only: the largest size of its queue and of its maps of view nodes, and
  /// the CPU time of copying the maps down.
  std::uint64_t queue_bytes = 0, unfused_bytes = 0;
  double fusion_seconds = 0;

  /// Largest number of pairs in a breadth-first queue, which contains one generation at a time.
  std::uint64_t queue_peak() const {
    return *std::max_element(generations.begin(), generations.end());
  }
  ManyViewsCounts& operator+=(const ManyViewsCounts& o);
};

/// How the scene is rendered into many views.
struct ManyViewsSettings {
  int map_size = 16;  ///< texels along a side of each paraboloid
  /// Largest diameter, in texels, of a node's sphere that is rendered as one texel, > 0; 1 in the
  /// paper. The image of a leaf's cube is as wide as that of its sphere over sqrt(3).
  float node_texels = 1;
  /// In [0, 1]: a node fills the texels whose centres lie within this fraction of its sphere's
  /// radius; 0: the texel that contains its centre, as in the paper.
  float cover = 0;
  bool share = true;  ///< false: every view leaf separately, as ManyLoDs (Hollaender et al. 2011)
  bool merge = true;  ///< false: only leaves are rendered, no inner nodes
  bool cull = true;
  /// Culls a scene node by the box of the leaves below it and the box of the views; false: by the
  /// spheres of both nodes, as in the paper.
  bool boxes = true;
  bool mips = false;           ///< draw large leaves into coarser levels of the maps: MipSplats
  bool breadth_first = false;  ///< use a queue, as in the paper; the same maps
};

/// Scene nodes by level.
using NodeLevels = std::array<NodeList, Octree::most_levels + 1>;

/// Renders nodes of a scene into the map of one view node at a time (Kol et al. 2018, 3.2), level
/// by level, eight scene nodes at once. Lengths, including those in maps, are in the grid of
/// SceneNodes.
class ViewRendering {
 public:
  /// The references must outlive this.
  ViewRendering(const SceneNodes& scene, const ViewTree& views, const ManyViewsSettings& settings);

  const SceneNodes& scene() const { return scene_; }
  /// The unit directions of a map's texels.
  std::vector<V3f> directions() const;
  /// Length of a map in floats: its texels, rounded up to whole vectors of eight, and one more
  /// vector.
  std::size_t map_floats() const { return x_.size(); }
  std::size_t texels() const { return static_cast<std::size_t>(map_.texels()); }
  bool is_leaf(std::uint32_t view) const { return views_.tree().nodes[view].children == 0; }
  /// The first node at or below `view` with several children, or none: the nodes between have the
  /// same views, so the same bounds and the same map.
  std::uint32_t fork(std::uint32_t view) const;
  /// Number of view subdivisions above a view node.
  int depth(std::uint32_t view) const { return settings_.share ? depth_[view] : 0; }

  /// Memory of a traversal, which each render() reuses.
  struct Scratch {
    NodeList split;                     ///< nodes of a level to subdivide
    std::array<NodeList, 2> fresh;      ///< children of these, alternating between levels
    std::vector<std::uint32_t> texels;  ///< splats of a level
    std::vector<float> distances;       ///< of the splats
    std::optional<MipSplats> mips;      ///< of one map
  };
  /// Renders the scene nodes `waiting`, and all nodes below them, into the map of a view node,
  /// which is a fork(). Replaces `later` by the nodes that the views below must decide.
  void render(std::uint32_t view, const NodeLevels& waiting, std::span<float> depths,
              NodeLevels& later, Scratch& scratch, ManyViewsCounts& counts) const;
  /// render() for nodes of one level, without the nodes below them: appends nodes to subdivide for
  /// this view node to scratch.split, and others that it cannot decide to `later`.
  void render_once(std::uint32_t view, int level, const NodeList& nodes, std::span<float> depths,
                   NodeList& later, Scratch& scratch, ManyViewsCounts& counts) const;

  /// Copies the map of `parent` to its `child` (3.2.5): distances to the same points from the
  /// child's own centre, in the same texels. Both spans have map_floats() elements.
  void hand_down(std::uint32_t parent, std::span<const float> from, std::uint32_t child,
                 std::span<float> to) const;
  /// The distances of a map in scene units.
  void to_scene_units(std::span<const float> depths, std::vector<float>& to) const;

 private:
  struct Visit;  // of a view node
  Visit visit(std::uint32_t view) const;
  unsigned culled(const Visit& v, int level, const NodeList::Eight& e, const Float8x3& d,
                  Float8 length2) const;
  void render_level(const Visit& v, int level, const NodeList& nodes, std::span<float> depths,
                    NodeList& later, Scratch& scratch, ManyViewsCounts& counts) const;
  void fill(const Visit& v, const NodeList& nodes, std::size_t first, std::span<float> depths,
            Scratch& scratch, ManyViewsCounts& counts) const;
  void fill_cap(int half, const Paraboloid::Rectangle& r, const V3f& w, float cosine,
                float distance, std::span<float> depths) const;

  const SceneNodes& scene_;
  const ViewTree& views_;
  ManyViewsSettings settings_;
  Paraboloid map_;
  std::vector<float> x_, y_, z_;     // components of the texels' directions
  std::vector<std::uint8_t> depth_;  // number of forks above each view node
};

}  // namespace lacuna
