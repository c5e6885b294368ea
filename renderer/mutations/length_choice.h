#pragma once

#include <algorithm>
#include <cmath>

#include "renderer/mutations/mutation.h"

namespace lacuna {

/// Chooses lengths of paths. Long paths carry less light, and there may be a thousand lengths: the
/// number of edges beyond the least is log-uniform.
class LengthChoice {
 public:
  explicit LengthChoice(const ChainPaths& paths)
      : least_(paths.least_edges),
        number_(paths.lengths.max_depth - paths.least_edges + 1),
        range_(std::log(number_ + 1.0)) {}

  /// Edges, for `u` uniform in [0, 1).
  int sample(double u) const {
    return least_ + std::clamp(static_cast<int>(std::exp(u * range_)) - 1, 0, number_ - 1);
  }
  /// Probability of `edges`, >= the least.
  double probability(int edges) const {
    const double longer = edges - least_;
    return std::log((longer + 2) / (longer + 1)) / range_;
  }

 private:
  int least_, number_;
  double range_;
};

}  // namespace lacuna
