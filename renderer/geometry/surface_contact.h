#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "renderer/core/bounds.h"
#include "renderer/geometry/rays.h"

namespace lacuna {

/// The surfaces that contain a point, up to the rounding of coordinates: a light in a ceiling, or a
/// camera on a wall. Rays from the point start beside each of them, on the side of the ray's
/// direction, and rays to it end there, so that neither side occludes the point. The surfaces
/// themselves receive nothing from it: their cosine is 0.
struct SurfaceContact {
  struct Plane {
    V3f ng{0, 0, 0};   ///< unit
    float offset = 0;  ///< distance at which rays start beside the plane, scene units
    std::uint32_t mesh = 0;
  };
  std::array<Plane, 3> planes;  ///< at most three, no two of them parallel
  int count = 0;

  /// The origin of a ray along `w` from the point `x`.
  V3f origin(const V3f& x, const V3f& w) const {
    V3f from = x;
    for (int i = 0; i < count; ++i) {
      const Plane& p = planes[static_cast<std::size_t>(i)];
      from += p.ng * std::copysign(p.offset, dot(w, p.ng));
    }
    return from;
  }
};

/// A scene's surfaces, as find_contact() needs them.
struct SurfaceSet {
  const SceneData& scene;
  const RayCaster& rays;  ///< of `scene`
  const Bounds& box;      ///< of all triangles
};
/// The surfaces that contain `x`, found by rays; none if `x` lies in no surface.
std::optional<SurfaceContact> find_contact(const SurfaceSet& surfaces, const V3f& x);

}  // namespace lacuna
