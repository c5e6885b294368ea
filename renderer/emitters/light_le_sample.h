#pragma once

#include <optional>

#include "renderer/core/bounds.h"
#include "renderer/core/rng.h"
#include "renderer/emitters/emitter_point.h"
#include "renderer/geometry/rays.h"

namespace lacuna {

/// The first edge of a light path.
struct LightLeSample {
  Ray ray;
  Pdf<SolidAngle> pdf{};    ///< EmitterPoint::pdf_Le() in the ray's direction
  Rgb throughput{0, 0, 0};  ///< emission times cosine over the densities of point and direction
};

/// Samples the first ray of a light path from `e`: with density cos / pi from an area light,
/// uniform over directions from a point light, uniform in the cone of a spot light, and from
/// infinity uniform over the silhouette of the scene's bounding box, so that every ray of a
/// directional light enters the box. None if `e` emits nothing in the sampled direction.
std::optional<LightLeSample> sample_Le(const EmitterPoint& e, const Bounds& scene, Rng& rng);

}  // namespace lacuna
