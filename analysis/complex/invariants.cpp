#include "analysis/complex/invariants.h"

#include "analysis/complex/complex_components.h"

namespace lacuna {

Topology topology(const CubicalComplex& complex) {
  Topology t;
  t.euler = complex.euler();
  t.components = component_count(complex);
  t.cavities = static_cast<std::ptrdiff_t>(ComplementComponents(complex).count()) - 1;
  t.tunnels = t.components + t.cavities - t.euler;
  return t;
}

}  // namespace lacuna
