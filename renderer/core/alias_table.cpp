#include "renderer/core/alias_table.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace lacuna {

AliasTable::AliasTable(std::span<const double> weights) {
  // Scaled by the largest first, so that neither tiny nor huge weights overflow their sum.
  double largest = 0;
  for (const double w : weights) {
    if (!(w >= 0) || !std::isfinite(w)) {
      throw std::invalid_argument("a weight of a distribution is negative or not finite");
    }
    largest = std::max(largest, w);
  }
  if (largest == 0) return;
  double sum = 0;
  for (const double w : weights) sum += w / largest;

  const auto n = weights.size();
  bins_.resize(n);
  std::vector<double> scaled(n);
  std::vector<std::uint32_t> small;
  std::vector<std::uint32_t> large;
  for (std::size_t i = 0; i < n; ++i) {
    const double p = weights[i] / largest / sum;
    scaled[i] = p * static_cast<double>(n);
    bins_[i] = {1.0F, static_cast<std::uint32_t>(i), static_cast<float>(p), 0};
    (scaled[i] < 1 ? small : large).push_back(static_cast<std::uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const auto s = small.back();
    const auto l = large.back();
    small.pop_back();
    bins_[s].threshold = static_cast<float>(scaled[s]);
    bins_[s].alias = l;
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  // A bin left in `small` by rounding would keep itself although its weight may be 0.
  const auto heaviest = static_cast<std::uint32_t>(
      std::max_element(weights.begin(), weights.end()) - weights.begin());
  for (const auto s : small) {
    if (weights[s] == 0) bins_[s] = {0.0F, heaviest, 0.0F, 0.0F};
  }
  for (Bin& b : bins_) b.alias_pmf = bins_[b.alias].pmf;
}

}  // namespace lacuna
