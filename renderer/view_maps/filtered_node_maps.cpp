#include "renderer/view_maps/filtered_node_maps.h"

#include <fmt/format.h>

#include "renderer/scene/scene_shape.h"

namespace lacuna {

namespace {

/// Increase it when the same inputs give different bits.
constexpr std::uint32_t node_maps_version = 1;

}  // namespace

std::vector<V3f> filtered_nodes(SpaceAnalysis& space) {
  const GridTransform transform = space.voxels().transform;
  std::vector<V3f> nodes;
  for (const Imath::V3i& corner : space.filtered().graph.corners) {
    nodes.emplace_back(transform.to_world(V3d(corner)));
  }
  return nodes;
}

std::shared_ptr<const NodeMaps> filtered_node_maps(const PrepareContext& context,
                                                   std::span<const V3f> nodes, int size) {
  auto maps = context.space.for_filtered<NodeMaps>(
      "node_maps", node_maps_version, fmt::format("map_size={}", size),
      occluder_key(context.scene.data()), [&](std::uint64_t byte_limit) {
        return trace_node_maps(context.scene, nodes, size, context.pool, byte_limit);
      });
  if (maps->points() != nodes.size() || maps->size != size) {
    throw std::runtime_error("the cache's node maps are not of its skeleton");
  }
  return maps;
}

}  // namespace lacuna
