#pragma once

#include "base/settings/field.h"

namespace lacuna {

/// Default side of the cube maps around the skeleton's nodes, in texels. Maps of equal size are
/// shared in the cache.
inline constexpr int node_map_size = 128;

template <class V>
void describe_node_map_size(V& v, int& map_size) {
  v("map_size", map_size,
    {.doc = "texels along a side of a map's six faces; 2 bytes each", .min = 8, .max = 1024});
}

}  // namespace lacuna
