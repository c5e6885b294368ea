#pragma once

#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// visibility: interpolated. The estimate is the mean visibility q of a light at the nearest cache
/// points, without shadow rays.
class InterpolatedVisibility : public VisibilityBase {
 public:
  explicit InterpolatedVisibility(const InterpolatedVisibilitySettings& settings)
      : points_(settings.cache_points, settings.neighbours, CachePoints::Keep::visibilities,
                settings.cache_lights) {}

  Counters begin(const LightPass& pass) {
    return pass.lights.is_first() ? points_.build(pass) : Counters{};
  }
  struct At {
    CachePoints::Neighbours neighbours;
  };
  At at(const ShadingPoint& point, const IterationContext&) const {
    return {points_.nearest(point)};
  }
  void decide(At& at, std::size_t block, const Terms&, VisibilityEstimate& d) const {
    d.tests = 0;
    points_.expected(at.neighbours, block, d.untested);
  }
  const CachePoints& points() const { return points_; }
  std::vector<std::pair<std::string, double>> statistics() const { return points_.statistics(); }

 protected:
  CachePoints points_;
};

/// guess: cache_points. The same q, and the lights that none of the points has tested are unknown.
struct CachePointsGuess : InterpolatedVisibility {
  using InterpolatedVisibility::InterpolatedVisibility;
  void decide(At& at, std::size_t block, const Terms& terms, VisibilityEstimate& d) const {
    d.tests = terms.lit & ~points_.expected(at.neighbours, block, d.untested);
  }
};

}  // namespace lacuna
