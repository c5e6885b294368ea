#pragma once

#include <vector>

#include "renderer/core/vec.h"

namespace lacuna {

/// What a state of a Markov chain contributes to the picture.
struct ChainState {
  struct Pixel {
    std::uint32_t index;
    Rgb value;
  };
  /// The picture is the mean, over all states of equal probability, of these, times its number of
  /// pixels.
  std::vector<Pixel> pixels;
  /// The sum of their luminances: the density that chains follow, up to a factor.
  double scalar = 0;

  void clear() {
    pixels.clear();
    scalar = 0;
  }
};

}  // namespace lacuna
