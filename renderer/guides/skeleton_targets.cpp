#include "renderer/guides/skeleton_targets.h"

#include <algorithm>

namespace lacuna {

namespace {

/// Nodes per task, which share the arrays of ImportancePaths.
constexpr std::size_t nodes_of_part = 16;

}  // namespace

std::vector<std::vector<Target>> skeleton_targets(const PrepareContext& context,
                                                  std::span<const double> importance,
                                                  ImportanceAim aim,
                                                  std::span<const std::uint32_t> nodes) {
  const GridTransform transform = context.space.voxels().transform;
  const SkeletonGraph& graph = context.space.skeleton();
  std::vector<std::vector<Target>> targets(nodes.size());
  if (std::none_of(importance.begin(), importance.end(), [](double f) { return f > 0; })) {
    return targets;
  }
  const auto position = [&](std::uint32_t node) {
    return V3f(transform.to_world(V3d(graph.corners[node])));
  };
  const std::size_t parts = (nodes.size() + nodes_of_part - 1) / nodes_of_part;
  context.pool.for_each(static_cast<int>(parts), [&](int part) {
    ImportancePaths paths(graph, importance, aim);
    const std::size_t first = static_cast<std::size_t>(part) * nodes_of_part;
    for (std::size_t i = first; i < std::min(nodes.size(), first + nodes_of_part); ++i) {
      context.pool.check_stop();
      const std::uint32_t node = nodes[i];
      const V3f from = position(node);
      const auto sees = [&](std::uint32_t other) {
        return graph.in_ball(other, node) ||
               !context.scene.rays().occluded({from, position(other) - from, 1.0F});
      };
      for (const ImportancePoint& p : paths.points(node, sees)) {
        targets[i].push_back({V3f(transform.to_world(p.at)), p.weight});
      }
    }
  });
  return targets;
}

}  // namespace lacuna
