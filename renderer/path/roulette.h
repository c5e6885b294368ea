#pragma once

#include <algorithm>
#include <cmath>

#include "renderer/path/guide.h"
#include "renderer/path/path_state.h"

namespace lacuna {

/// Russian roulette and splitting. Without a guide, roulette by the throughput ends paths, from
/// `depth` edges on. A guided path is kept within a window: adjoint-driven Russian roulette and
/// splitting (Vorba and Krivanek 2016) keeps the luminance that it is expected to add to the
/// picture near the value at its first connectible vertex. Guiding multiplies the weight by a
/// factor at each vertex; without a window the variance of the product grows exponentially with the
/// depth. GuidedRoulette::throughput undoes the window.
class Roulette {
 public:
  struct Limits {
    int depth = 1;        ///< edges before a path may end
    int split_depth = 1;  ///< edges before it may be split
    Transport transport = Transport::radiance;
  };

  Roulette(const Guide& guide, const Limits& limits)
      : guide_(guide), limits_(limits), windows_(guide.windows(limits.transport)) {}

  /// The number of equal parts in which path `w` continues from its last vertex `v`; 0: it ends.
  /// The throughput of a survivor is divided by its probability of survival; the caller divides it
  /// among the parts.
  int parts(PathState& w, const Vertex& v) const {
    RouletteState& state = w.roulette;
    state.windowed = false;
    if (!windows_ || !v.bsdf->connectible()) return 1;
    const float carried = state.carried_before * luminance(w.throughput);
    if (state.reference == 0) {
      state.reference = w.depth;
      state.least = carried * least_part;
      return 1;
    }
    // The factor by which guiding has changed the weight.
    const float guiding_weight = 1 / state.scale;
    if (guiding_weight <= high && w.depth < limits_.depth) return 1;
    if (state.expected < 0) {
      const Vertex& first = w.path[static_cast<std::size_t>(state.reference)];
      state.expected = state.least / least_part * expected_after(first);
    }
    if (!(state.expected > 0)) return 1;
    const float ratio = carried * expected_after(v) / state.expected;
    state.windowed = true;
    if (ratio < low && w.depth >= limits_.depth) {
      return apply(w, std::max(ratio / low, min_survival)) ? 1 : 0;
    }
    // Splitting undoes at most the factor of guiding: splitting all paths that reach bright regions
    // costs more time than the lower variance saves.
    const float excess = std::min({ratio, guiding_weight, float{max_parts}});
    const bool splits = excess > high && carried > state.least && w.depth >= limits_.split_depth;
    return splits ? static_cast<int>(std::lround(excess)) : 1;
  }

  /// Roulette by the throughput, after the next direction is sampled, unless parts() has decided by
  /// the window. False: the path ends.
  bool survives(PathState& w) const {
    if (w.depth < limits_.depth || w.roulette.windowed) return true;
    const float survival =
        std::min(1.0F, w.roulette.carried_before * max_component(w.throughput) * w.roulette.scale);
    if (!w.rng.decide(survival)) return false;
    w.throughput /= survival;
    return true;
  }

 private:
  static constexpr float low = 1.0F / 3, high = 5.0F / 3;  // 2 / (1 + s) and 2 s / (1 + s), s = 5
  static constexpr float min_survival = 0.1F;
  static constexpr int max_parts = 16;
  // On average, the throughputs of all parts of a path sum to at most its own. The smallest part
  // that may be split therefore bounds their number, and the time that wrong estimates cost.
  static constexpr float least_part = 1.0F / 64;

  /// Roulette with probability `survival`. False: the path ends.
  static bool apply(PathState& w, float survival) {
    if (!w.rng.decide(survival)) return false;
    w.throughput /= survival;
    w.roulette.scale *= survival;
    return true;
  }

  /// Guide::expected() of `v`. Light paths, and eye paths while it is unknown, use 1: as if it were
  /// equal everywhere.
  float expected_after(const Vertex& v) const {
    const float known = limits_.transport == Transport::radiance ? guide_.expected(v) : -1;
    return known < 0 ? 1 : known;
  }

  const Guide& guide_;
  Limits limits_;
  bool windows_;
};

}  // namespace lacuna
