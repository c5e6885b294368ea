#pragma once

#include <functional>

#include "base/parallel/thread_pool.h"
#include "renderer/view_maps/view_rendering.h"

namespace lacuna {

/// Receives the map of a leaf in [0, ViewTree::leaf_count()): a distance for each texel.
using UseMap = std::function<void(std::uint32_t leaf, std::span<const float> depths)>;

/// Renders a scene's octree into the leaves of a view tree by traversing both simultaneously (Kol
/// et al. 2018, 3.2). Calls `use(leaf, depths)` with each leaf's complete map, from any thread, in
/// any order: distances from the centre of the leaf's sphere to the centre of the nearest node
/// behind each texel of Paraboloid{map_size}, infinite for empty texels. Independent of the number
/// of threads.
///
/// The paper processes a queue of pairs; this traverses the views depth-first, unless
/// `breadth_first`. Scene nodes that a view node cannot decide for all its views are deferred in
/// one list that its children share, and the map of a node is copied to its children (the paper's
/// fusion), so only the maps between the root and one leaf are in memory at a time.
ManyViewsCounts render_views(const SceneNodes& scene, const ViewTree& views,
                             const ManyViewsSettings& settings, const ThreadPool& pool,
                             const UseMap& use);

}  // namespace lacuna
