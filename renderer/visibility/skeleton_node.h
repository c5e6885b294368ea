#pragma once

#include "analysis/skeleton/surface_lookup.h"
#include "renderer/many_lights/vpl_contributions.h"

namespace lacuna {

/// The skeleton node of a light; no_node for a light at infinity or far from all empty space.
inline std::uint32_t node_of(const SurfaceLookup& lookup, const VplGeometry& light) {
  if (light.infinite) return no_node;
  // A point light lies in empty space: its own voxel is found for any normal.
  const V3d n(light.n == V3f(0.0F) ? V3f(0, 0, 1) : light.n);
  return lookup.node(V3d(light.x), n, n);
}

/// The node of a shading point, or no_node.
inline std::uint32_t node_of(const SurfaceLookup& lookup, const ShadingPoint& point) {
  const Vertex& v = *point.vertex;
  return lookup.node(V3d(v.surface.x), V3d(v.surface.ng), V3d(v.wp));
}

}  // namespace lacuna
