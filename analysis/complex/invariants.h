#pragma once

#include <cstddef>

#include "analysis/complex/cubical_complex.h"

namespace lacuna {

/// The topological invariants of a complex, which thinning preserves.
struct Topology {
  std::ptrdiff_t euler = 0;       ///< Euler characteristic
  std::ptrdiff_t components = 0;  ///< b0
  std::ptrdiff_t tunnels = 0;     ///< b1
  std::ptrdiff_t cavities = 0;    ///< b2
  bool operator==(const Topology&) const = default;
};

/// Computed without thinning: components and cavities (components of the complement except the
/// outside) by union-find over runs of cells, the Euler characteristic chi by counting faces, and
/// tunnels from b0 - b1 + b2 = chi (Euler and Poincare).
Topology topology(const CubicalComplex& complex);

}  // namespace lacuna
