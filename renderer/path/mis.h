#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace lacuna {

/// What multiple importance sampling has to know of one vertex of a whole path, x_0 on the emitter
/// to x_k at the eye: the densities with which it would be generated from either end, in one and
/// the same measure.
struct VertexPdfs {
  double from_light = 0;
  double from_eye = 0;
  bool connectible =
      true;  ///< can be an end of a connecting edge: not scattering through a delta lobe
};

/// Strategies s = 0 .. max_s (vertices made from the emitter) that an integrator uses, each with
/// the number of samples it takes. Path tracing without and with next event estimation: {1}, {1,
/// 1}.
struct StrategySet {
  std::span<const double> samples;  ///< n_s, by s
};

/// Balance heuristic (Veach 1997, 9.2.2; Noel 2015, 4.3): the share of strategy `s` in
/// sum_i n_i p_i(path) over the strategies of `set` that can make this path. p_s is the product of
/// from_light below s and of from_eye from s on, so only ratios of neighbours are needed. `path`
/// holds at least the vertices 0 .. samples.size() - 1 (or all there are).
inline double mis_weight(std::span<const VertexPdfs> path, int s, const StrategySet& set) {
  const auto possible = [&](std::size_t i) {
    // Strategy i joins x_{i-1} and x_i; strategy 0 hits the emitter and joins nothing.
    return i == 0 || (path[i - 1].connectible && path[i].connectible);
  };
  const auto own = static_cast<std::size_t>(s);
  double sum = set.samples[own];
  double ratio = 1;
  for (std::size_t i = own; i > 0; --i) {
    ratio *= path[i - 1].from_eye / path[i - 1].from_light;
    if (possible(i - 1)) sum += set.samples[i - 1] * ratio;
  }
  ratio = 1;
  for (std::size_t i = own + 1; i < set.samples.size() && i < path.size(); ++i) {
    ratio *= path[i - 1].from_light / path[i - 1].from_eye;
    if (possible(i)) sum += set.samples[i] * ratio;
  }
  return set.samples[own] / sum;
}

}  // namespace lacuna
