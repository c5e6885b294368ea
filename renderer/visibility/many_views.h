#pragma once

#include <array>
#include <functional>

#include "analysis/parallel/thread_pool.h"
#include "renderer/visibility/paraboloid.h"
#include "renderer/visibility/view_tree.h"

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

  /// Pairs that the paper's breadth-first queue, in which a generation lies at a time, would hold.
  std::uint64_t queue_peak() const {
    return *std::max_element(generations.begin(), generations.end());
  }
  ManyViewsCounts& operator+=(const ManyViewsCounts& o);
};

/// How the scene is rendered into many views.
struct ManyViewsSettings {
  int map_size = 16;  ///< texels along a side of each paraboloid
  bool share = true;  ///< false: every view leaf by itself, ManyLoDs (Hollaender et al. 2011)
  bool cull = true;
};

/// Takes the map of a leaf, in [0, ViewTree::leaf_count()): of each texel a distance.
using UseMap = std::function<void(std::uint32_t leaf, std::span<const float> depths)>;

/// Renders a scene's octree into the leaves of a view tree by traversing both at once (Kol et al.
/// 2018, 3.2). `use(leaf, depths)` gets each leaf's map, complete, from any thread, in any order:
/// distances from the centre of the leaf's sphere to the centre of the nearest node behind each
/// texel of Paraboloid{map_size}, infinite where nothing is. The same for any number of threads.
///
/// Where the paper keeps a queue of pairs, this goes depth-first through the views: what a view
/// node cannot decide for all its views waits in one list that its children share, and the map of a
/// node is handed down to its children as it is (the paper's fusion), so only the maps between the
/// root and one leaf are there at a time.
ManyViewsCounts render_views(const Octree& scene, const ViewTree& views,
                             const ManyViewsSettings& settings, const ThreadPool& pool,
                             const UseMap& use);

}  // namespace lacuna
