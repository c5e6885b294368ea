#include "renderer/guides/skeleton_lobes.h"

#include <algorithm>

namespace lacuna {

namespace {

/// Nodes of one task, which share the arrays of ImportancePaths.
constexpr std::uint32_t nodes_of_part = 16;

}  // namespace

std::vector<LobeSet> skeleton_lobes(const PrepareContext& context,
                                    std::span<const double> importance, ImportanceAim aim) {
  const GridTransform transform = context.space.voxels().transform;
  const SkeletonGraph& graph = context.space.skeleton();
  std::vector<LobeSet> lobes(graph.nodes());
  if (std::none_of(importance.begin(), importance.end(), [](double f) { return f > 0; })) {
    return lobes;
  }
  const auto position = [&](std::uint32_t node) {
    return V3f(transform.to_world(V3d(graph.corners[node])));
  };
  const auto count = static_cast<std::uint32_t>(graph.nodes());
  context.pool.for_each(static_cast<int>((count + nodes_of_part - 1) / nodes_of_part), [&](int i) {
    ImportancePaths paths(graph, importance, aim);
    const auto first = static_cast<std::uint32_t>(i) * nodes_of_part;
    for (std::uint32_t node = first; node < std::min(count, first + nodes_of_part); ++node) {
      context.pool.check_stop();
      const V3f from = position(node);
      const auto sees = [&](std::uint32_t other) {
        return graph.in_ball(other, node) ||
               !context.scene.rays().occluded({from, position(other) - from, 1.0F});
      };
      std::vector<Target> targets;
      for (const ImportancePoint& p : paths.points(node, sees)) {
        targets.push_back({V3f(transform.to_world(p.at)), p.weight});
      }
      lobes[node] = LobeSet(targets);
    }
  });
  return lobes;
}

}  // namespace lacuna
