#pragma once

#include "renderer/view_maps/many_views.h"

namespace lacuna {

/// render_views() as published: a queue of pairs of a scene node and a view node, all of a
/// generation before the next, into a map for each view node (with `share` false: for each leaf);
/// then these maps are handed down to the leaves (Kol et al. 2018, 3.2, 3.2.5). The maps are those
/// of the depth-first traversal, bit by bit; the counts tell what the queue and the maps took.
///
/// Pairs of one view node are looked at by one thread at a time. `scene_empty`: nothing is to be
/// rendered. Throws std::runtime_error if the maps would take more than half of the free memory.
ManyViewsCounts render_breadth_first(const ViewRendering& rendering, const ViewTree& views,
                                     bool scene_empty, bool share, const ThreadPool& pool,
                                     const UseMap& use);

}  // namespace lacuna
