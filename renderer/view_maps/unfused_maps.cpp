#include "renderer/view_maps/unfused_maps.h"

#include <limits>

namespace lacuna {

UnfusedMaps::UnfusedMaps(const ViewRendering& rendering, const ViewTree& views, std::uint32_t first,
                         std::vector<float> maps)
    : first_(first),
      first_leaf_(views.first_leaf()),
      floats_(rendering.map_floats()),
      unit_(static_cast<float>(rendering.scene().unit())),
      directions_(rendering.directions()),
      nodes_(views.tree().nodes.size() - first),
      maps_(std::move(maps)) {
  const SceneNodes& scene = rendering.scene();
  for (std::uint32_t view = first; view < first + nodes_.size(); ++view) {
    if (rendering.fork(view) != view) continue;
    const Octree::Node& node = views.tree().nodes[view];
    for (std::uint32_t c = 0; c < node.children; ++c) {
      const std::uint32_t child = rendering.fork(node.first_child + c);
      nodes_[child - first] = {
          view, scene.to_grid(views.node(view).centre) - scene.to_grid(views.node(child).centre)};
    }
  }
}

float UnfusedMaps::distance(std::uint32_t leaf, int texel, std::uint64_t& read) const {
  std::array<std::uint32_t, Octree::most_levels + 1> path;
  std::size_t n = 0;
  for (std::uint32_t v = first_leaf_ + leaf; v != none; v = nodes_[v - first_].parent)
    path[n++] = v;
  read += n;
  constexpr float nothing = std::numeric_limits<float>::infinity();
  float depth = nothing;
  while (n-- > 0) {
    const std::size_t i = path[n] - first_;
    // As ViewRendering::hand_down().
    if (depth < nothing) {
      const V3f moved = nodes_[i].step + directions_[static_cast<std::size_t>(texel)] * depth;
      depth = std::sqrt(moved.length2());
    }
    depth = std::min(depth, maps_[i * floats_ + static_cast<std::size_t>(texel)]);
  }
  return depth * unit_;
}

}  // namespace lacuna
