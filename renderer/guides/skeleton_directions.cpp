#include "renderer/guides/skeleton_directions.h"

#include <algorithm>

#include "renderer/guides/arriving_power.h"
#include "renderer/guides/skeleton_lobes.h"

namespace lacuna {

void SkeletonDirections::prepare(const PrepareContext& context) {
  const SkeletonGraph& graph = context.space.skeleton();
  lookup_.emplace(context.space.voxels().transform, context.space.node_map());
  const std::vector<double> importance =
      arriving_power(context.scene, *lookup_, graph.nodes(), settings_.light_rays, context.pool);
  importance_nodes_ = static_cast<std::size_t>(
      std::count_if(importance.begin(), importance.end(), [](double f) { return f > 0; }));
  std::vector<float> strengths{static_cast<float>(settings_.strength.value.value_or(0))};
  if (settings_.strength.is_auto()) strengths = LobeSet::powers();
  tuning_ = Tuning(std::move(strengths), settings_.probability, graph.nodes());
  lobes_ = skeleton_lobes(context, importance, settings_.aim);
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
