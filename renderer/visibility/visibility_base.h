#pragma once

#include "renderer/many_lights/cache_points.h"
#include "renderer/many_lights/visibility_estimate.h"
#include "renderer/path/strategy.h"

namespace lacuna {

/// Defaults of the concept Visibility, for a strategy that treats all lights equally.
struct VisibilityBase : StrategyBase {
  /// The group of a light; the lights of a group are consecutive.
  static std::uint32_t group(const VplGeometry&) { return 0; }
  /// The number of groups: group() is below it, or no_group.
  static std::uint64_t groups() { return 1; }
  /// The cell of a light or a point, and the rate of visibility, in (0, 1], between the points of a
  /// cell and the lights of a block.
  template <class Point>
  static std::uint32_t cell(const Point&) {
    return 0;
  }
  static std::uint32_t cells() { return 1; }
  static float rate(std::uint32_t /*cell*/, std::size_t /*block*/) { return 1; }
  /// As a guess (visibility_guess.h): the time of one light, in units of its shadow ray.
  static constexpr float guess_cost = 0;
  /// The ranges of blocks processed one after another; together they are all blocks.
  static std::vector<BlockRange> passes(const VplSet&) { return {{}}; }
  /// Called for each pass when the lights of an iteration are complete.
  static Counters begin(const LightPass&) { return {}; }
  /// Called when all passes of an iteration are complete.
  static void end() {}
  /// Called with the points that are gathered together, and their states.
  template <class At>
  static void share(std::span<const ShadingPoint>, std::span<At>, const IterationContext&) {}
  /// Whether no light of `block` illuminates the point.
  template <class At>
  static bool hides(At&, std::size_t /*block*/) {
    return false;
  }
  /// What a strategy that learns from tests keeps of a test until its ray is traced: of light `i`
  /// of the block that decide() was called for last. seen() is called if the light is visible.
  struct Tested {};
  template <class At>
  static Tested tested(const At&, int /*i*/) {
    return {};
  }
  template <class At>
  static void seen(At&, Tested) {}
  /// Whether negative pixels become black.
  static bool clamps_negative() { return false; }
};

/// Tests every light that has a contribution.
inline void test_all(const Terms& terms, VisibilityEstimate& d) {
  d.tests = terms.lit;
  d.untested.v.fill(0);
  d.gain.v.fill(1);
}

}  // namespace lacuna
