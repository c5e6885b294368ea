#include "renderer/visibility/node_map_visibility.h"

namespace lacuna {

void NodeMapVisibility::prepare(const PrepareContext& context) {
  nodes_ = filtered_nodes(context.space);
  lookup_.emplace(context.space.voxels().transform, context.space.filtered_map());
  maps_ = filtered_node_maps(context, nodes_, settings_.map_size);
}

Counters NodeMapVisibility::begin(const LightPass& pass) {
  const VplSet& lights = pass.terms.lights();
  std::vector<std::uint32_t> view_of_node(nodes_.size(), no_group);
  views_.clear();
  view_of_.assign(lights.blocks(), no_group);
  for (std::size_t b = 0; b < lights.blocks(); ++b) {
    const std::uint32_t node = group(lights.geometry(b, 0));
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
