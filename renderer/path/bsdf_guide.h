#pragma once

#include "renderer/path/guide.h"

namespace lacuna {

/// guide: bsdf. Samples the BSDF alone.
struct BsdfGuide : StrategyBase {
  /// It learns nothing.
  struct Accumulator {
    static constexpr double bytes() { return 0; }
  };
  static constexpr bool has_expected = false;
  static constexpr bool learns() { return false; }
  static Accumulator accumulator() { return {}; }
  static void accumulate(const GuidingSample&, Accumulator&) {}
  static void update(std::span<Accumulator>, const ThreadPool&, double) {}

  static void on_hit(Vertex&) {}
  static std::optional<BsdfSample> sample(const Vertex& v, Rng& rng, Transport transport) {
    const auto [u_lobe, u] = rng.next_choice_and_point();
    return v.bsdf->sample(v.wp, u_lobe, u, transport);
  }
  /// Density of `wi` for a walk of the given transport that arrived at `v` from `wo`.
  static Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport) {
    return v.bsdf->pdf(wo, wi, transport);
  }
  static Pdf<SolidAngle> pdf(const Vertex&, const V3f&, const V3f&, Transport,
                             Pdf<SolidAngle> bsdf) {
    return bsdf;
  }
};
static_assert(Guide<BsdfGuide>);

}  // namespace lacuna
