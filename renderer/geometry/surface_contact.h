#pragma once

#include <array>
#include <cmath>
#include <optional>

#include "renderer/core/bounds.h"
#include "renderer/geometry/rays.h"

namespace lacuna {

/// The surfaces that a point in space lies in, up to the rounding of coordinates: a light in a
/// ceiling, or a camera on a wall. Rays from the point start beside each of them, on the side that
/// they go to, and rays to it end there: neither side hides the point, and the surfaces themselves,
/// which see it at a cosine of 0, get nothing from it.
struct SurfaceContact {
  struct Plane {
    V3f ng{0, 0, 0};   ///< unit
    float offset = 0;  ///< by which rays start beside it, scene units
    std::uint32_t mesh = 0;
  };
  std::array<Plane, 3> planes;  ///< of more surfaces, the first three that are not parallel
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

/// The surfaces of a scene.
struct SurfaceSet {
  const SceneData& scene;
  const RayCaster& rays;  ///< of `scene`
  const Bounds& box;      ///< of all triangles
};
/// The surfaces that the point `x` lies in, as rays meet them; none: it is free.
std::optional<SurfaceContact> find_contact(const SurfaceSet& surfaces, const V3f& x);

}  // namespace lacuna
