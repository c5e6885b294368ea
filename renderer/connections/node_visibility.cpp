#include "renderer/connections/node_visibility.h"

#include "renderer/connections/node_weights.h"
#include "renderer/view_maps/filtered_node_maps.h"

namespace lacuna {

namespace {

/// One in this number of map results is verified by a ray: too few to affect the time.
constexpr std::size_t check_every = 64;
/// Bilinear comparison of the nearest texels. A wider filter, as for the visibility of many lights,
/// would blur shadow edges, which a probability does not need.
constexpr int filter_of_decisions = 1;

}  // namespace

std::vector<double> visible_fractions(const LightVertices& lights, int s, const NodeView& view) {
  const auto on_surface = [&](const V3f& y, const V3f& ng) {
    return double(view.visible_fraction(y, dot(view.point() - y, ng) < 0 ? -ng : ng));
  };
  std::vector<double> visible;
  for (std::size_t i = 0; i < lights.count(s); ++i) {
    if (s > 1) {
      const Surface& y = lights.at(s, i).surface;
      visible.push_back(on_surface(y.x, y.ng));
    } else if (const EmitterPoint& e = lights.emitter(i); e.infinite()) {
      visible.push_back(double(view.open(e.x)));
    } else if (e.kind == EmitterPoint::Kind::area) {
      visible.push_back(on_surface(e.x, e.ng));
    } else {
      visible.push_back(double(view.visible_fraction(e.x)));
    }
  }
  return visible;
}

void NodeVisibility::prepare(const PrepareContext& context, std::span<const V3f> nodes,
                             const SkeletonConnectionsSettings& settings) {
  nodes_ = nodes;
  maps_.reset();
  if (settings.visible && settings.node_visibility == NodeVisibilityTest::node_maps) {
    maps_ = filtered_node_maps(context, nodes, settings.map_size);
  }
}

std::vector<double> NodeVisibility::between(const IterationContext& context, std::size_t node,
                                            const LightVertices& lights, int s,
                                            Tests& tests) const {
  if (maps_ != nullptr) return by_map(context, node, lights, s, tests);
  const std::vector<Ray> rays = rays_to(lights, s, nodes_[node]);
  std::vector<std::uint8_t> occluded(rays.size());
  context.scene.rays().occluded(rays, occluded);
  tests.rays += rays.size();
  std::vector<double> visible;
  for (const std::uint8_t hidden : occluded) visible.push_back(hidden != 0 ? 0 : 1);
  return visible;
}

std::vector<double> NodeVisibility::by_map(const IterationContext& context, std::size_t node,
                                           const LightVertices& lights, int s, Tests& tests) const {
  const NodeView view(*maps_, node, nodes_[node], filter_of_decisions);
  const std::vector<double> visible = visible_fractions(lights, s, view);
  for (std::size_t i = context.iteration % check_every; i < visible.size(); i += check_every) {
    const bool clear = !context.scene.rays().occluded(ray_to(lights, s, i, nodes_[node]));
    ++tests.rays;
    ++tests.checked;
    if (clear != (visible[i] > 0.5)) ++tests.wrong;
  }
  return visible;
}

}  // namespace lacuna
