#pragma once

#include "renderer/core/rng.h"
#include "renderer/path/vertex.h"

namespace lacuna {

/// guide: bsdf. A guide draws the next direction at a vertex and knows the density of any direction
/// there; the walk and the MIS weights take whatever density it reports.
struct BsdfGuide {
  static std::optional<BsdfSample> sample(const Vertex& v, Rng& rng, Transport transport) {
    const float u_lobe = rng.next();
    return v.bsdf->sample(v.wp, u_lobe, rng.next2(), transport);
  }
  static Pdf<SolidAngle> pdf(const Vertex& v, const V3f& wi) { return v.bsdf->pdf(v.wp, wi); }
};

}  // namespace lacuna
