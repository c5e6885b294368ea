#include "renderer/core/alias_table.h"

#include <algorithm>
#include <cmath>

#include "renderer/core/weights.h"

namespace lacuna {

namespace {

/// The threshold, of 2^32, below which a bin returns its own index: `weight` fills the part
/// `scaled` < 1 of its bin.
std::uint32_t threshold(double weight, double scaled) {
  if (weight == 0) return 0;
  return static_cast<std::uint32_t>(std::clamp(std::round(scaled * 0x1p32), 1.0, 0x1p32 - 1));
}

}  // namespace

AliasTable::AliasTable(std::span<const double> weights) {
  const auto [largest, sum] = WeightSum(weights);
  if (largest == 0) return;

  const auto n = weights.size();
  bins_.resize(n);
  std::vector<double> scaled(n);
  std::vector<std::uint32_t> small;
  std::vector<std::uint32_t> large;
  for (std::size_t i = 0; i < n; ++i) {
    const auto own = static_cast<std::uint32_t>(i);
    scaled[i] = weights[i] / largest / sum * static_cast<double>(n);
    bins_[i] = {0, own, 0, 0};  // a full bin: it is its own alias
    (scaled[i] < 1 ? small : large).push_back(own);
  }
  while (!small.empty() && !large.empty()) {
    const auto s = small.back();
    const auto l = large.back();
    small.pop_back();
    bins_[s] = {threshold(weights[s], scaled[s]), l, 0, 0};
    scaled[l] -= 1 - scaled[s];
    if (scaled[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  // Rounding can leave a bin in `small`; without an alias it would return its own index even at
  // weight 0.
  const auto heaviest = static_cast<std::uint32_t>(
      std::max_element(weights.begin(), weights.end()) - weights.begin());
  for (const auto s : small) {
    if (weights[s] == 0) bins_[s].alias = heaviest;
  }
  set_probabilities();
}

void AliasTable::set_probabilities() {
  // choose() returns bin i for the random numbers from ceil(2^32 i / n).
  const std::uint64_t n = bins_.size();
  const auto first = [n](std::uint64_t i) { return ((i << 32) + n - 1) / n; };
  std::vector<double> draws(n);  // each index, of 2^64: sums of integers, to double precision
  for (std::uint64_t i = 0; i < n; ++i) {
    const auto width = static_cast<double>(first(i + 1) - first(i));
    const Bin& b = bins_[i];
    draws[i] += width * double(b.threshold);
    draws[b.alias] += width * (0x1p32 - double(b.threshold));
  }
  for (std::uint64_t i = 0; i < n; ++i) bins_[i].pmf = static_cast<float>(draws[i] * 0x1p-64);
  for (Bin& b : bins_) b.alias_pmf = bins_[b.alias].pmf;
}

}  // namespace lacuna
