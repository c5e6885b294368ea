#pragma once

#include <optional>

#include "renderer/core/bounds.h"
#include "renderer/core/rng.h"
#include "renderer/emitters/emitter_point.h"
#include "renderer/geometry/rays.h"

namespace lacuna {

/// The first edge of a light path.
struct Leaving {
  Ray ray;
  Pdf<SolidAngle> pdf{};    ///< EmitterPoint::leaving_pdf() of the ray's direction
  Rgb throughput{0, 0, 0};  ///< emission times cosine over the densities of point and direction
};

/// Samples the first ray of a light path from `e`: with density cos / pi from an area light,
/// uniform over directions from a point light, uniform in the cone of a spot light, and uniform
/// over the silhouette of the scene's bounding box from infinity, so that every ray of a
/// directional light enters the box. Nothing where `e` emits no light.
std::optional<Leaving> sample_leaving(const EmitterPoint& e, const Bounds& scene, Rng& rng);

}  // namespace lacuna
