#include "renderer/connections/skeleton_connections.h"

#include <numeric>

#include "renderer/connections/node_weights.h"

namespace lacuna {

void SkeletonConnections::prepare(const PrepareContext& context) {
  const GridTransform transform = context.space.voxels().transform;
  for (const Imath::V3i& corner : context.space.filtered().graph.corners) {
    positions_.emplace_back(transform.to_world(V3d(corner)));
  }
  least_distance_ = transform.voxel_size / 2;
  lookup_.emplace(transform, context.space.filtered_map());
  cells_of_nodes_.resize(positions_.size());
}

bool SkeletonConnections::accepted(std::uint64_t mapped, std::uint64_t sum) const {
  // Noel 2015, 11.4: left out are nodes "mapping to fewer eye vertices than the mean". Its formula
  // has <=, by which the only node of a small room would be left out, too.
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
  std::vector<std::uint64_t> rays(used.size());
  context.pool.for_each(static_cast<int>(used.size()), [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    rays[k] = build(used[k], context, lights);
  });
  counters.shadow_rays += std::accumulate(rays.begin(), rays.end(), std::uint64_t{0});
}

std::uint64_t SkeletonConnections::build(std::size_t node, const IterationContext& context,
                                         const LightVertices& lights) {
  std::uint64_t rays_sent = 0;
  for (int s = 1; s <= lights.longest(); ++s) {
    context.check_stop();
    const std::size_t n = lights.count(s);
    std::vector<double> weights(n, 0.0);
    std::vector<double> visible(n, 0.0);
    if (settings_.visible || settings_.unshadowed) {
      weights = node_weights(lights, s, positions_[node], least_distance_, settings_.sides);
    }
    if (settings_.visible) {
      const std::vector<Ray> rays = rays_to(lights, s, positions_[node]);
      std::vector<std::uint8_t> occluded(n);
      context.scene.rays().occluded(rays, occluded);
      rays_sent += n;
      for (std::size_t i = 0; i < n; ++i) visible[i] = occluded[i] != 0 ? 0 : weights[i];
    }
    if (!settings_.unshadowed) weights.assign(n, 0.0);
    const std::vector<double> same(n, 1.0);
    const std::array<std::span<const double>, 3> all{visible, weights, same};
    cells_of_nodes_[node].set(s, ResamplingTable(all, settings_.combination));
  }
  return rays_sent;
}

std::vector<std::pair<std::string, double>> SkeletonConnections::statistics() const {
  return {{"nodes", static_cast<double>(positions_.size())},
          {"nodes_used", static_cast<double>(used_)}};
}

}  // namespace lacuna
