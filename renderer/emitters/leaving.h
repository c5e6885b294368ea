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
  Rgb throughput{0, 0, 0};  ///< emission, with its cosine, over the densities of point and ray
};

/// Draws the ray along which a light path leaves `e`: with density cos / pi from an area, uniform
/// in directions from a point and in the cone of a spot, uniform over the silhouette of the scene's
/// bounding box from infinity: no ray of a directional light passes the scene by. Nothing where no
/// light leaves.
std::optional<Leaving> sample_leaving(const EmitterPoint& e, const Bounds& scene, Rng& rng);

}  // namespace lacuna
