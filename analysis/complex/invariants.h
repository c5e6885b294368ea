#pragma once

#include <cstddef>

#include "analysis/complex/cubical_complex.h"

namespace lacuna {

/// What thinning must not change.
struct Topology {
  std::ptrdiff_t euler = 0;       ///< Euler characteristic
  std::ptrdiff_t components = 0;  ///< b0
  std::ptrdiff_t tunnels = 0;     ///< b1
  std::ptrdiff_t cavities = 0;    ///< b2
  bool operator==(const Topology&) const = default;
};

/// Counted without any thinning: components and cavities (components of the complement but the
/// outside) by union-find over runs of cells, the Euler characteristic by counting faces, tunnels
/// from the three by Euler and Poincare: b0 - b1 + b2 = chi.
Topology topology(const CubicalComplex& complex);

}  // namespace lacuna
