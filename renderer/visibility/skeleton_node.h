#pragma once

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/many_lights/vpl_contributions.h"

namespace lacuna {

/// The node that a light belongs to, or no_node: of one at infinity, and where no space is near.
inline std::uint32_t node_of(const SurfaceLookup& lookup, const VplGeometry& light) {
  if (light.infinite) return no_node;
  // A point light lies in empty space: whatever way it faces, that is where it is looked up.
  const V3d n(light.n == V3f(0.0F) ? V3f(0, 0, 1) : light.n);
  return lookup.node(V3d(light.x), n, n);
}

/// The node that a shading point belongs to, or no_node.
inline std::uint32_t node_of(const SurfaceLookup& lookup, const ShadingPoint& point) {
  const Vertex& v = *point.vertex;
  return lookup.node(V3d(v.surface.x), V3d(v.surface.ng), V3d(v.wp));
}

}  // namespace lacuna
