#pragma once

#include "analysis/skeleton/surface_lookup.h"
#include "analysis/space_analysis/space_analysis.h"
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

/// The visibility clusters of lights and of shading points.
class ClusterLookup {
 public:
  explicit ClusterLookup(SpaceAnalysis& space)
      : lookup_(space.voxels().transform, space.node_map()), count_(space.clusters().count) {
    for (const std::uint32_t n : space.simplified().parent) {
      cluster_of_.push_back(space.clusters().of_node[n]);
    }
  }
  std::uint32_t count() const { return count_; }
  /// The cluster of a light or of a shading point, below count(); no_group: none.
  template <class Point>
  std::uint32_t of(const Point& point) const {
    const std::uint32_t node = node_of(lookup_, point);
    return node == no_node ? no_group : cluster_of_[node];
  }

 private:
  SurfaceLookup lookup_;
  std::vector<std::uint32_t> cluster_of_;  // of each skeleton node
  std::uint32_t count_;
};

}  // namespace lacuna
