#include "renderer/connections/skeleton_connections.h"

#include "renderer/connections/node_weights.h"
#include "renderer/view_maps/filtered_node_maps.h"

namespace lacuna {

void SkeletonConnections::prepare(const PrepareContext& context) {
  positions_ = filtered_nodes(context.space);
  const GridTransform transform = context.space.voxels().transform;
  least_distance_ = transform.voxel_size / 2;
  lookup_.emplace(transform, context.space.filtered_map());
  visibility_.prepare(context, positions_, settings_);
  cells_of_nodes_.resize(positions_.size());
}

bool SkeletonConnections::accepted(std::uint64_t mapped, std::uint64_t sum) const {
  // Noel 2015, 11.4, excludes nodes "mapping to fewer eye vertices than the mean". Its formula has
  // <=, which would also exclude the only node of a small room.
  const double mean = double(sum) / double(positions_.size());
  return mapped > 0 && double(mapped) >= settings_.acceptance * mean;
}

void SkeletonConnections::begin(const IterationContext& context, const LightVertices& lights,
                                const CellStatistics& statistics, Counters& counters) {
  std::uint64_t sum = 0;
  for (std::size_t n = 0; n < cells_of_nodes_.size(); ++n)
    sum += statistics.visits(static_cast<std::uint32_t>(n));
  std::vector<std::size_t> used;
  for (std::size_t n = 0; n < cells_of_nodes_.size(); ++n) {
    cells_of_nodes_[n].clear();
    if (accepted(statistics.visits(static_cast<std::uint32_t>(n)), sum)) used.push_back(n);
  }
  used_ = used.size();
  std::vector<NodeVisibility::Tests> tests(used.size());
  context.pool.for_each(static_cast<int>(used.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    tests[k] = build(used[k], context, lights);
  });
  for (const NodeVisibility::Tests& of_node : tests) {
    counters.shadow_rays += of_node.rays;
    tests_ += of_node;
  }
}

NodeVisibility::Tests SkeletonConnections::build(std::size_t node, const IterationContext& context,
                                                 const LightVertices& lights) {
  NodeVisibility::Tests tests;
  for (int s = 1; s <= lights.longest(); ++s) {
    context.check_stop();
    const std::size_t n = lights.count(s);
    std::vector<double> weights(n, 0.0);
    std::vector<double> visible(n, 0.0);
    if (settings_.visible || settings_.unshadowed) {
      weights = node_weights(lights, s, positions_[node], least_distance_, settings_.sides);
    }
    if (settings_.visible) {
      visible = visibility_.between(context, node, lights, s, tests);
      for (std::size_t i = 0; i < n; ++i) visible[i] *= weights[i];
    }
    if (!settings_.unshadowed) weights.assign(n, 0.0);
    const std::vector<double> same(n, 1.0);
    const std::array<std::span<const double>, 3> all{visible, weights, same};
    cells_of_nodes_[node].set(s, ResamplingTable(all, settings_.combination));
  }
  return tests;
}

std::vector<std::pair<std::string, double>> SkeletonConnections::statistics() const {
  std::vector<std::pair<std::string, double>> stats{
      {"nodes", static_cast<double>(positions_.size())},
      {"nodes_used", static_cast<double>(used_)}};
  if (visibility_.by_maps()) {
    stats.emplace_back("map_decisions_checked", static_cast<double>(tests_.checked));
    stats.emplace_back("map_decisions_wrong", static_cast<double>(tests_.wrong));
  }
  return stats;
}

}  // namespace lacuna
