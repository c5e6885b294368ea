#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "renderer/core/density.h"
#include "renderer/core/sampling.h"
#include "renderer/core/vec.h"

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
  /// emitter. Environment: per steradian. Delta: the selection probability.
  Pdf<Area> pdf{};
  float cos_inner = 1, cos_outer = 0;  ///< of a spot's cones
  std::uint32_t entry = ~0U;           ///< the emitter's number in its EmitterSet
  /// The density of the point in next event estimation at one receiver, over `pdf`; 1 where both
  /// select by power.
  float next_event_ratio = 1;
  float across = 0;  ///< infinite: projected area of the scene's bounding box from that direction

  /// Density of the point in next event estimation.
  Pdf<Area> next_event_pdf() const { return next_event_ratio * pdf; }
  bool infinite() const { return kind == Kind::directional || kind == Kind::environment; }
  /// Paths cannot hit it.
  bool delta() const {
    return kind == Kind::point || kind == Kind::spot || kind == Kind::directional;
  }

  /// The emission towards unit `w`.
  Rgb towards(const V3f& w) const {
    if (kind == Kind::area && !both_sides && dot(w, ng) <= 0) return Rgb(0, 0, 0);
    if (kind == Kind::spot) return emission * spot_falloff(dot(w, ng));
    return emission;
  }

  /// Density with which sample_leaving() continues a light path along unit `w`. Infinite emitters:
  /// uniform per area across `w`.
  Pdf<SolidAngle> leaving_pdf(const V3f& w) const {
    switch (kind) {
      case Kind::area: {
        const float c = dot(w, ng);
        if (both_sides) return Pdf<SolidAngle>(std::abs(c) * (0.5F * inv_pi));
        return Pdf<SolidAngle>(std::max(c, 0.0F) * inv_pi);
      }
      case Kind::point:
        return Pdf<SolidAngle>(0.25F * inv_pi);
      case Kind::spot:  // the cone may be empty in floats
        return Pdf<SolidAngle>(dot(w, ng) > cos_outer && cos_outer < 1 ? 1 / cone() : 0);
      default:
        return Pdf<SolidAngle>(across > 0 ? 1 / across : 0);
    }
  }

  /// Solid angle of a spot's outer cone.
  float cone() const { return 2 * pi * (1 - cos_outer); }

 private:
  /// KHR_lights_punctual: squared ramp between the cones.
  float spot_falloff(float cos_angle) const {
    const float ramp =
        std::clamp((cos_angle - cos_outer) / std::max(cos_inner - cos_outer, 1e-4F), 0.0F, 1.0F);
    return ramp * ramp;
  }
};

}  // namespace lacuna
