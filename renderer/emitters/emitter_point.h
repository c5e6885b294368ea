#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "renderer/core/density.h"
#include "renderer/core/sampling.h"
#include "renderer/core/vec.h"
#include "renderer/emitters/spot_cones.h"
#include "renderer/geometry/surface.h"
#include "renderer/geometry/surface_contact.h"

namespace lacuna {

/// A point on an emitter, or a direction towards an emitter at infinity.
struct EmitterPoint {
  enum class Kind : std::uint8_t { area, point, spot, directional, environment };
  Kind kind = Kind::area;
  bool both_sides = false;  ///< area: emits from its back side too
  float offset = 0;         ///< area: ray_offset() at x
  V3f x{0, 0, 0};           ///< position; of an infinite emitter: unit direction towards it
  V3f ng{0, 0, 0};          ///< area: unit normal of the front; spot: unit axis
  Rgb emission{0, 0, 0};    ///< radiance; W/sr (spot: on its axis); W/m^2 of a directional light
  /// Density with which EmitterSet::sample() returns the point, including the selection of the
  /// emitter. Environment: per steradian. Delta emitter: the selection probability.
  Pdf<Area> pdf{};
  SpotCones cones;            ///< of a spot
  std::uint32_t entry = ~0U;  ///< the emitter's number in its EmitterSet
  /// The point's density in next event estimation at one receiver, over `pdf`; 1 if both select
  /// emitters by power.
  float next_event_ratio = 1;
  float across = 0;  ///< infinite: projected area of the scene's bounding box in that direction
  /// Point and spot lights: the surfaces that contain it; null if there are none.
  const SurfaceContact* contact = nullptr;

  /// Density of the point in next event estimation.
  Pdf<Area> next_event_pdf() const { return next_event_ratio * pdf; }
  bool infinite() const { return kind == Kind::directional || kind == Kind::environment; }
  /// Whether paths cannot hit it.
  bool delta() const {
    return kind == Kind::point || kind == Kind::spot || kind == Kind::directional;
  }

  /// The emission towards unit `w`.
  Rgb towards(const V3f& w) const {
    if (kind == Kind::area && !both_sides && dot(w, ng) <= 0) return Rgb(0, 0, 0);
    if (kind == Kind::spot) return emission * cones.falloff(one_minus_cos(w, ng));
    return emission;
  }

  /// The origin of a ray along unit `w` from a finite point, offset from the surfaces that contain
  /// it.
  V3f origin(const V3f& w) const {
    return kind == Kind::area ? offset_origin(x, ng, offset, w) : origin_in_space(w);
  }
  /// The end of a segment of length `distance` along -`w` to a finite point.
  V3f end(const V3f& w, float distance) const {
    return kind == Kind::area ? offset_end(x, ng, offset, w, distance) : origin_in_space(w);
  }

  /// Density with which sample_Le() continues a light path along unit `w`. Infinite emitters:
  /// uniform per area perpendicular to `w`.
  Pdf<SolidAngle> pdf_Le(const V3f& w) const {
    switch (kind) {
      case Kind::area: {
        const float c = dot(w, ng);
        if (both_sides) return Pdf<SolidAngle>(std::abs(c) * (0.5F * inv_pi));
        return Pdf<SolidAngle>(std::max(c, 0.0F) * inv_pi);
      }
      case Kind::point:
        return Pdf<SolidAngle>(0.25F * inv_pi);
      case Kind::spot:
        return cones.contains(one_minus_cos(w, ng)) ? cones.pdf() : Pdf<SolidAngle>(0);
      default:
        return Pdf<SolidAngle>(across > 0 ? 1 / across : 0);
    }
  }

 private:
  V3f origin_in_space(const V3f& w) const { return contact == nullptr ? x : contact->origin(x, w); }
};

}  // namespace lacuna
