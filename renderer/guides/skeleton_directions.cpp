#include "renderer/guides/skeleton_directions.h"

#include <algorithm>

#include "renderer/guides/arriving_power.h"
#include "renderer/guides/importance_points.h"

namespace lacuna {

namespace {

/// Nodes of one task, which share the arrays of ImportancePaths.
constexpr std::uint32_t nodes_of_part = 16;

}  // namespace

void SkeletonDirections::prepare(const PrepareContext& context) {
  const GridTransform transform = context.space.voxels().transform;
  const SkeletonGraph& graph = context.space.skeleton();
  lookup_.emplace(transform, context.space.node_map());
  const std::vector<double> importance =
      arriving_power(context.scene, *lookup_, graph.nodes(), settings_.light_rays, context.pool);
  importance_nodes_ = static_cast<std::size_t>(
      std::count_if(importance.begin(), importance.end(), [](double f) { return f > 0; }));
  lobes_.resize(graph.nodes());
  std::vector<float> strengths{static_cast<float>(settings_.strength.value.value_or(0))};
  if (settings_.strength.is_auto()) strengths = LobeSet::powers();
  tuning_ = Tuning(std::move(strengths), settings_.probability, graph.nodes());
  if (importance_nodes_ == 0) return;

  const auto position = [&](std::uint32_t node) {
    return V3f(transform.to_world(V3d(graph.corners[node])));
  };
  const auto count = static_cast<std::uint32_t>(graph.nodes());
  context.pool.for_each(static_cast<int>((count + nodes_of_part - 1) / nodes_of_part), [&](int i) {
    ImportancePaths paths(graph, importance, settings_.aim);
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
      lobes_[node] = LobeSet(targets);
    }
  });
}

void SkeletonDirections::accumulate(const GuidingSample& sample, Accumulator& accumulator) const {
  const GuidingCell& cell = sample.v.guiding_cell;
  // A node whose probability is 0 at present keeps learning.
  if (cell.index >= lobes_.size() || lobes_[cell.index].empty()) return;
  if (!tuning_.wants(cell.index)) return;
  const LobeSet& lobes = lobes_[cell.index];
  const V3f& x = sample.v.surface.x;
  auto& own = static_cast<TuningAccumulator&>(accumulator).tuning;
  if (settings_.strength.is_auto()) {
    tuning_.accumulate(sample, cell.index, lobes.pdf_of_powers(x, sample.wi), own);
  } else {
    const float density = lobes.pdf(x, sample.wi, tuning_.strength(cell.index)).value;
    tuning_.accumulate(sample, cell.index, std::span(&density, 1), own);
  }
}

std::vector<std::pair<std::string, double>> SkeletonDirections::statistics() const {
  std::size_t most = 0, all = 0, guided = 0;
  for (const LobeSet& l : lobes_) {
    most = std::max(most, l.size());
    all += l.size();
    guided += l.empty() ? 0 : 1;
  }
  std::vector<std::pair<std::string, double>> stats{
      {"nodes", static_cast<double>(lobes_.size())},
      {"importance_nodes", static_cast<double>(importance_nodes_)},
      {"guided_nodes", static_cast<double>(guided)},
      {"lobes_most", static_cast<double>(most)},
      {"lobes_mean", guided > 0 ? static_cast<double>(all) / static_cast<double>(guided) : 0.0}};
  for (auto& s : tuning_.statistics()) stats.push_back(std::move(s));
  return stats;
}

}  // namespace lacuna
