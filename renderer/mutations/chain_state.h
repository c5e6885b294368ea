#pragma once

#include <vector>

#include "renderer/core/vec.h"
#include "renderer/path/path_letters.h"

namespace lacuna {

/// The contribution of a state of a Markov chain to the picture.
struct ChainState {
  struct Pixel {
    std::uint32_t index;
    Rgb value;
  };
  /// The picture is the mean of these over all states with equal probability, times its number of
  /// pixels.
  std::vector<Pixel> pixels;
  /// The same light by path, for the layers of light; empty without these.
  struct Part {
    std::uint32_t index;
    std::uint16_t edges;
    PathMatches matches;
    Rgb value;
  };
  std::vector<Part> parts;
  /// The sum of their luminances: the chain's target density, up to a factor.
  double scalar = 0;

  void clear() {
    pixels.clear();
    parts.clear();
    scalar = 0;
  }
};

}  // namespace lacuna
