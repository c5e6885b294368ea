#include "renderer/guides/skeleton_directions.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "renderer/guides/arriving_power.h"
#include "renderer/guides/skeleton_targets.h"

namespace lacuna {

void SkeletonDirections::prepare(const PrepareContext& context) {
  const std::size_t nodes = context.space.skeleton().nodes();
  lookup_.emplace(context.space.voxels().transform, context.space.node_map());
  const std::vector<double> importance =
      to_eye_
          ? arriving_importance(context.scene, context.camera, *lookup_, nodes, rays_, context.pool)
          : arriving_power(context.scene, *lookup_, nodes, rays_, context.pool);
  importance_nodes_ = static_cast<std::size_t>(
      std::count_if(importance.begin(), importance.end(), [](double f) { return f > 0; }));
  std::vector<std::uint32_t> all(nodes);
  std::iota(all.begin(), all.end(), 0U);
  for (const std::vector<Target>& of : skeleton_targets(context, importance, aim_, all)) {
    lobes_.emplace_back(of);
  }
  if (strength_.is_auto()) {
    light_.assign(nodes, Strengths{});
    weights_.assign(nodes, weights(Strengths{}));
  }
}

SkeletonDirections::Strengths SkeletonDirections::weights(const Strengths& light) {
  // A fraction of all weight, distributed evenly (a prior), so that a small weight can grow again.
  constexpr double prior_share = 0.05;
  const double all = std::accumulate(light.begin(), light.end(), 0.0);
  Strengths weights;
  for (std::size_t k = 0; k < light.size(); ++k) {
    const double share = all > 0 ? light[k] / all : 1 / double(light.size());
    weights[k] = (1 - prior_share) * share + prior_share / double(light.size());
  }
  return weights;
}

double SkeletonDirections::mixture(const Strengths& weights, const Densities& densities) {
  double sum = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * double(densities[k]);
  return sum;
}

std::optional<V3f> SkeletonDirections::sample(const GuidedVertex& at, Rng::FinePoint u,
                                              Rng&) const {
  const LobeSet& lobes = lobes_[at.cell.index];
  if (!strength_.is_auto()) return lobes.sample(at.x(), fixed(), u);
  const Strengths& weights = weights_[at.cell.index];
  double left = static_cast<double>(u.x) * 0x1p-64;
  std::size_t k = 0;
  while (k + 1 < weights.size() && left >= weights[k]) left -= weights[k++];
  u.x = static_cast<std::uint64_t>(std::min(left / weights[k], 1 - 0x1p-53) * 0x1p64);
  return lobes.sample(at.x(), LobeSet::power(k), u);
}

Pdf<SolidAngle> SkeletonDirections::pdf(const GuidedVertex& at, const V3f& w) const {
  const LobeSet& lobes = lobes_[at.cell.index];
  if (!strength_.is_auto()) return lobes.pdf(at.x(), w, fixed());
  const auto densities = lobes.pdf_of_powers(at.x(), w);
  return Pdf<SolidAngle>(static_cast<float>(mixture(weights_[at.cell.index], densities)));
}

std::vector<std::uint32_t> SkeletonDirections::update(const TrainingSamples& samples,
                                                      const ThreadPool& pool) {
  if (!strength_.is_auto()) return {};
  pool.for_each(static_cast<int>(lobes_.size()), [&](int i) {
    const auto node = static_cast<std::size_t>(i);
    Strengths& light = light_[node];
    for (const TrainingSample& s : samples.of(node)) {
      if (!(s.pdf > 0) || !(s.reflected > 0)) continue;
      const auto densities = lobes_[node].pdf_of_powers(s.x, s.w);
      const double sum = mixture(weights_[node], densities);
      if (!(sum > 0)) continue;
      for (std::size_t k = 0; k < light.size(); ++k) {
        light[k] += double(s.reflected) * weights_[node][k] * double(densities[k]) / sum;
      }
    }
    weights_[node] = weights(light);
  });
  return {};
}

void SkeletonDirections::load(ByteReader& in) {
  std::vector<Strengths> light = in.get_vector<Strengths>();
  bool good = light.size() == light_.size();
  for (const Strengths& f : light) {
    for (const double x : f) good = good && std::isfinite(x) && x >= 0;
  }
  if (!good) throw std::runtime_error("saved strengths belong to another scene");
  light_ = std::move(light);
  for (std::size_t node = 0; node < light_.size(); ++node) weights_[node] = weights(light_[node]);
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
      {to_eye_ ? "seen_nodes" : "importance_nodes", static_cast<double>(importance_nodes_)},
      {"guided_nodes", static_cast<double>(guided)},
      {"lobes_most", static_cast<double>(most)},
      {"lobes_mean", guided > 0 ? static_cast<double>(all) / static_cast<double>(guided) : 0.0}};
  if (!strength_.is_auto()) return stats;
  double logs = 0;
  for (const Strengths& w : weights_) {
    for (std::size_t k = 0; k < w.size(); ++k) logs += w[k] * double(k);
  }
  const double n = double(std::max<std::size_t>(weights_.size(), 1));
  stats.emplace_back("mean_strength", std::exp2(logs / n));
  return stats;
}

}  // namespace lacuna
