#pragma once

#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// visibility: exact. A shadow ray for every light.
struct ExactVisibility : VisibilityBase {
  explicit ExactVisibility(const ExactVisibilitySettings&) {}
  struct At {};
  static At at(const ShadingPoint&, const IterationContext&) { return {}; }
  static void decide(At&, std::size_t, const Terms& terms, VisibilityEstimate& d) {
    test_all(terms, d);
  }
};

/// visibility: none. V = 1 for every light.
struct NoVisibility : VisibilityBase {
  explicit NoVisibility(const NoVisibilitySettings&) {}
  struct At {};
  static At at(const ShadingPoint&, const IterationContext&) { return {}; }
  static void decide(At&, std::size_t, const Terms&, VisibilityEstimate& d) {
    d.tests = 0;
    d.untested.v.fill(1);
  }
};

}  // namespace lacuna
