#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

namespace lacuna {

/// The largest weight of a distribution, and the sum of all weights divided by it, so that the sum
/// neither overflows nor underflows.
struct WeightSum {
  double largest = 0;  ///< 0 if all weights are
  double sum = 0;      ///< of weight / largest

  /// Throws std::invalid_argument on a negative or non-finite weight.
  explicit WeightSum(std::span<const double> weights) {
    for (const double w : weights) {
      if (!(w >= 0) || !std::isfinite(w)) {
        throw std::invalid_argument("a weight of a distribution is negative or not finite");
      }
      largest = std::max(largest, w);
    }
    if (largest == 0) return;
    for (const double w : weights) sum += w / largest;
  }
};

}  // namespace lacuna
