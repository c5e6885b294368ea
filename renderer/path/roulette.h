#pragma once

#include "renderer/path/vertex.h"

namespace lacuna {

/// Decides how often a path goes on at a vertex, by what is known of the light behind it.
class Roulette {
 public:
  virtual ~Roulette() = default;

  /// The best number of continuations of a path at the connectible vertex `v`, with at most
  /// `edges_left` > 0 behind it: below 1 the probability to go on; below 0 where nothing is known.
  /// `throughput`: its luminance.
  virtual float continuations(const Vertex& v, int edges_left, float throughput) const = 0;
};

}  // namespace lacuna
