#pragma once

#include "renderer/materials/interface.h"

namespace lacuna {

/// Probabilities that a facet reflects and that it transmits.
struct FacetProbabilities {
  double reflect = 1, transmit = 0;

  FacetProbabilities() = default;  ///< only reflection
  explicit FacetProbabilities(const Interface::Split& split)
      : FacetProbabilities(split.reflected, split.transmitted) {}
  FacetProbabilities(const Rgb& reflected, const Rgb& transmitted) {
    const double r = double(luminance(reflected));
    const double t = double(luminance(transmitted));
    if (r + t == 0) return;
    reflect = r / (r + t);
    transmit = t / (r + t);
  }
};

}  // namespace lacuna
