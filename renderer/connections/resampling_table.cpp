#include "renderer/connections/resampling_table.h"

#include <numeric>

namespace lacuna {

namespace {

double sum(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

ResamplingTable::ResamplingTable(std::span<const std::span<const double>> weights,
                                 Combination combination) {
  const std::size_t n = weights.front().size();
  std::vector<double> scale;  // 1 over the sum of each distribution, 0 if that is 0
  std::size_t in_use = 0;
  for (const auto& w : weights) {
    const double all = sum(w);
    scale.push_back(all > 0 ? 1 / all : 0);
    in_use += all > 0 ? 1 : 0;
  }
  if (in_use == 0) return;

  distributions_.resize(n);
  std::vector<double> kept(weights.size(), 0.0);  // what remains of each after the max heuristic
  std::vector<double> combined(n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    double most = 0;
    double all = 0;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const double p = weights[k][i] * scale[k];
      all += p;
      if (p > most) {
        most = p;
        distributions_[i] = static_cast<std::uint8_t>(k);
      }
    }
    kept[distributions_[i]] += most;
    combined[i] = combination == Combination::max ? most : all;
  }
  if (combination == Combination::max) {
    for (std::size_t i = 0; i < n; ++i) {
      if (combined[i] > 0) combined[i] /= kept[distributions_[i]];
    }
  }
  table_ = AliasTable(combined);
}

}  // namespace lacuna
