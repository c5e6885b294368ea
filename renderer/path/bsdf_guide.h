#pragma once

#include <optional>
#include <span>

#include "renderer/core/rng.h"
#include "renderer/path/guiding_sample.h"
#include "renderer/path/strategy.h"

namespace lacuna {

/// guide: bsdf. A guide draws the next direction at a vertex and knows the density of any direction
/// there; the walk and the MIS weights take whatever density it reports.
struct BsdfGuide : StrategyBase {
  /// There is nothing to learn.
  struct Tally {};
  static constexpr bool learns() { return false; }
  static Tally tally() { return {}; }
  static void learn(const GuidingSample&, Tally&) {}
  static void end(std::span<const Tally>, const ThreadPool&) {}

  static void arrive(Vertex&) {}
  static std::optional<BsdfSample> sample(const Vertex& v, Rng& rng, Transport transport) {
    const float u_lobe = rng.next();
    return v.bsdf->sample(v.wp, u_lobe, rng.next2(), transport);
  }
  /// Density of `wi` for a walk of kind `transport` that arrived at `v` from `wo`.
  static Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wo, const V3f& wi, Transport transport) {
    return v.bsdf->pdf(wo, wi, transport);
  }
};

}  // namespace lacuna
