#pragma once

#include "renderer/path/guide.h"

namespace lacuna {

/// guide: bsdf. The BSDF's own directions.
struct BsdfGuide : StrategyBase {
  /// There is nothing to learn.
  struct Tally {};
  static constexpr bool learns() { return false; }
  static Tally tally() { return {}; }
  static void learn(const GuidingSample&, Tally&) {}
  static void end(std::span<const Tally>, const ThreadPool&) {}

  static void arrive(Vertex&) {}
  static std::optional<BsdfSample> sample(const Vertex& v, Rng& rng, Transport transport) {
    const auto [u_lobe, u] = rng.next_choice_and_point();
    return v.bsdf->sample(v.wp, u_lobe, u, transport);
  }
  /// Density of `wi` for a walk of kind `transport` that arrived at `v` from `wo`.
  static Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport) {
    return v.bsdf->pdf(wo, wi, transport);
  }
};
static_assert(Guide<BsdfGuide>);

}  // namespace lacuna
