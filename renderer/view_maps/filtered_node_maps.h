#pragma once

#include "renderer/path/contexts.h"
#include "renderer/view_maps/node_maps.h"

namespace lacuna {

/// The positions of the nodes of the filtered skeleton, scene units.
std::vector<V3f> filtered_nodes(SpaceAnalysis& space);

/// Cube maps of depth around `nodes`, which must be filtered_nodes(), from the cache or newly
/// traced (Noel 2015, 8.3). `size`: texels along a side of a face, in [8, 1024]. Throws
/// MemoryLimitError, and std::runtime_error if the cache's maps belong to other nodes.
std::shared_ptr<const NodeMaps> filtered_node_maps(const PrepareContext& context,
                                                   std::span<const V3f> nodes, int size);

}  // namespace lacuna
