#pragma once

#include <algorithm>
#include <cmath>

#include "renderer/mutations/mutation.h"

namespace lacuna {

/// Selects path lengths. Long paths carry less light, and there may be a thousand lengths, so the
/// number of edges beyond the minimum is log-uniform.
class LengthChoice {
 public:
  explicit LengthChoice(const ChainPaths& paths)
      : least_(paths.least_edges),
        number_(paths.lengths.max_depth - paths.least_edges + 1),
        range_(std::log(number_ + 1.0)) {}

  /// Number of edges, from `u` uniform in [0, 1).
  int sample(double u) const {
    return least_ + std::clamp(static_cast<int>(std::exp(u * range_)) - 1, 0, number_ - 1);
  }
  /// Probability of `edges`, at least the minimum.
  double probability(int edges) const {
    const double longer = edges - least_;
    return std::log((longer + 2) / (longer + 1)) / range_;
  }

 private:
  int least_, number_;
  double range_;
};

}  // namespace lacuna
