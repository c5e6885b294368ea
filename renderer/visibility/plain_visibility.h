#pragma once

#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/cache_points.h"
#include "renderer/visibility/decision.h"

namespace lacuna {

// A visibility says what is taken for V between shading points and virtual lights:
//
//   Counters begin(const LightPass&);  once the lights of an iteration are there
//   struct At;  At at(const ShadingPoint&, const IterationContext&) const;  of a shading point
//   void decide(At&, std::size_t block, const Terms&, Decision&) const;  of a block of lights
//   statistics(), and whether negative pixels are to become black.

/// visibility: exact.
struct ExactVisibility {
  explicit ExactVisibility(const ExactVisibilitySettings&) {}
  static Counters begin(const LightPass&) { return {}; }
  struct At {};
  static At at(const ShadingPoint&, const IterationContext&) { return {}; }
  static void decide(At&, std::size_t, const Terms& terms, Decision& d) {
    d.tests = terms.lit;
    d.untested.v.fill(0);
    d.gain.v.fill(1);
  }
  static bool clamps_negative() { return false; }
  static std::vector<std::pair<std::string, double>> statistics() { return {}; }
};

/// visibility: none.
struct NoVisibility {
  explicit NoVisibility(const NoVisibilitySettings&) {}
  static Counters begin(const LightPass&) { return {}; }
  struct At {};
  static At at(const ShadingPoint&, const IterationContext&) { return {}; }
  static void decide(At&, std::size_t, const Terms&, Decision& d) {
    d.tests = 0;
    d.untested.v.fill(1);
  }
  static bool clamps_negative() { return false; }
  static std::vector<std::pair<std::string, double>> statistics() { return {}; }
};

}  // namespace lacuna
