#include "renderer/visibility/node_map_visibility.h"

#include <fmt/format.h>

#include "renderer/scene/scene_shape.h"

namespace lacuna {

namespace {

/// Increased when the same inputs give other bits.
constexpr std::uint32_t node_maps_version = 1;

}  // namespace

void NodeMapVisibility::prepare(const PrepareContext& context) {
  SpaceAnalysis& space = context.space;
  const GridTransform transform = space.voxels().transform;
  for (const Imath::V3i& corner : space.filtered().graph.corners) {
    nodes_.emplace_back(transform.to_world(V3d(corner)));
  }
  lookup_.emplace(transform, space.filtered_map());
  maps_ = space.for_filtered<NodeMaps>(
      "node_maps", node_maps_version, fmt::format("map_size={}", settings_.map_size),
      occluder_key(context.scene.data()), [&](std::uint64_t byte_limit) {
        return trace_node_maps(context.scene, nodes_, settings_.map_size, context.pool, byte_limit);
      });
  if (maps_->points() != nodes_.size() || maps_->size != settings_.map_size) {
    throw std::runtime_error("the cache's node maps are not of its skeleton");
  }
}

Counters NodeMapVisibility::begin(const LightPass& pass) {
  const VplSet& lights = pass.terms.lights();
  std::vector<std::uint32_t> view_of_node(nodes_.size(), no_group);
  views_.clear();
  view_of_.assign(lights.blocks(), no_group);
  for (std::size_t b = 0; b < lights.blocks(); ++b) {
    const std::uint32_t node = lights.group(b);
    if (node == no_group) continue;
    if (view_of_node[node] == no_group) {
      view_of_node[node] = static_cast<std::uint32_t>(views_.size());
      views_.emplace_back(*maps_, node, nodes_[node], settings_.filter);
    }
    view_of_[b] = view_of_node[node];
  }
  return {};
}

NodeMapVisibility::At NodeMapVisibility::at(const ShadingPoint& point,
                                            const IterationContext&) const {
  return {point.vertex->surface.x, point.vertex->side(), std::vector<float>(views_.size(), -1.0F)};
}

std::vector<std::pair<std::string, double>> NodeMapVisibility::statistics() const {
  return {{"nodes", static_cast<double>(nodes_.size())},
          {"nodes_used", static_cast<double>(views_.size())}};
}

}  // namespace lacuna
