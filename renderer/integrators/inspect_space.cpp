#include "renderer/integrators/inspect_space.h"

#include "renderer/core/false_colour.h"
#include "renderer/settings/inspect_settings.h"

namespace lacuna {

SpaceView::SpaceView(InspectQuantity quantity, const PrepareContext& context)
    : quantity_(quantity), transform_(context.space.voxels().transform) {
  SpaceAnalysis& space = context.space;
  switch (quantity) {
    case InspectQuantity::filtered_mapping:
      graph_ = &space.filtered().graph;
      lookup_.emplace(transform_, space.filtered_map());
      return;
    case InspectQuantity::opening:
      opening_ = &space.regions().opening;
      lookup_.emplace(transform_, space.regions().label);
      return;
    case InspectQuantity::region_labels:
      lookup_.emplace(transform_, space.regions().label);
      return;
    case InspectQuantity::visibility_clusters:
      parent_ = &space.simplified().parent;
      cluster_ = &space.clusters().of_node;
      [[fallthrough]];
    default:
      graph_ = &space.skeleton();
      lookup_.emplace(transform_, space.node_map());
  }
}

Rgb SpaceView::colour(const Scene& scene, const Surface& s, const V3f& d, std::uint64_t seed,
                      Counters& counters) const {
  const V3d x(s.x), n(s.ng), w(-d);
  if (quantity_ == InspectQuantity::opening) {
    const auto voxel = lookup_->voxel(x, n, w);
    const double radius = voxel ? (*opening_)(*voxel) * transform_.voxel_size : 0;
    return Rgb(static_cast<float>(radius));
  }
  const std::uint32_t label = lookup_->node(x, n, w);
  if (label == no_node) return {0, 0, 0};
  if (quantity_ == InspectQuantity::nearest_node_visible) return sight(scene, s, label, counters);
  return false_colour(label_of_node(label), seed);
}

std::uint32_t SpaceView::label_of_node(std::uint32_t node) const {
  return cluster_ == nullptr ? node : (*cluster_)[(*parent_)[node]];
}

Rgb SpaceView::sight(const Scene& scene, const Surface& s, std::uint32_t node,
                     Counters& counters) const {
  const V3f to(transform_.to_world(V3d(graph_->corners[node])));
  const V3f from = offset_origin(s.x, s.ng, s.offset, to - s.x);
  ++counters.shadow_rays;
  return scene.rays().occluded({from, to - from, 1.0F}) ? Rgb(1, 0, 0) : Rgb(0, 1, 0);
}

}  // namespace lacuna
