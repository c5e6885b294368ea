#pragma once

#include "renderer/view_maps/many_views.h"
#include "renderer/view_maps/unfused_maps.h"

namespace lacuna {

/// render_views() as published: processes a queue of pairs of a scene node and a view node,
/// generation by generation, into a map for each view node (with `share` false: for each leaf),
/// then copies these maps down to the leaves (Kol et al. 2018, 3.2, 3.2.5). The maps are
/// bit-identical to those of the depth-first traversal; the counts include the memory of the queue
/// and of the maps.
///
/// At most one thread at a time processes the pairs of a view node. Throws MemoryLimitError if
/// there is no memory for the maps.
ManyViewsCounts render_breadth_first(const ViewRendering& rendering, const ViewTree& views,
                                     bool share, const ThreadPool& pool, const UseMap& use);

/// The same traversal without fusion: the maps of all view nodes. `counts` replaces its counts.
UnfusedMaps render_unfused(const SceneNodes& scene, const ViewTree& views,
                           const ManyViewsSettings& settings, const ThreadPool& pool,
                           ManyViewsCounts& counts);

}  // namespace lacuna
