#pragma once

#include "renderer/many_lights/cache_points.h"
#include "renderer/many_lights/visibility_estimate.h"
#include "renderer/path/strategy.h"

namespace lacuna {

/// The answers of a visibility that treats all lights alike (see the concept Visibility).
struct VisibilityBase : StrategyBase {
  /// Lights of which groups it wants to meet one after another.
  static std::uint32_t group(const VplGeometry&) { return 0; }
  /// Which lights it treats at a time: all blocks, one range after another.
  static std::vector<BlockRange> passes(const VplSet&) { return {{}}; }
  /// Once the lights of an iteration are there, for each of the passes.
  static Counters begin(const LightPass&) { return {}; }
  /// No light of `block` shines on the point, whatever it would give.
  template <class At>
  static bool hides(At&, std::size_t /*block*/) {
    return false;
  }
  /// Negative pixels are to become black.
  static bool clamps_negative() { return false; }
};

/// Every light that could add something is tested.
inline void test_all(const Terms& terms, VisibilityEstimate& d) {
  d.tests = terms.lit;
  d.untested.v.fill(0);
  d.gain.v.fill(1);
}

}  // namespace lacuna
