#pragma once

#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/test_probability.h"
#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// visibility: probabilistic. With q the mean visibility of a light at the nearest cache points,
/// the estimate is q with probability p, without a shadow ray, and (v - p q) / (1 - p) with
/// probability 1 - p, where v is the result of the shadow ray. Its mean is v for any q and p
/// (Nabata et al., eq. 6). p is large where the cache points agree.
class ProbabilisticVisibility : public VisibilityBase {
 public:
  explicit ProbabilisticVisibility(const ProbabilisticVisibilitySettings& settings)
      : settings_(settings),
        points_(settings.cache_points, settings.neighbours, CachePoints::Keep::visibilities,
                settings.cache_lights) {}

  Counters begin(const LightPass& pass);
  struct At {
    CachePoints::Neighbours neighbours;
    TestProbability chance;
    Rng rng;
  };
  At at(const ShadingPoint& point, const IterationContext& context) const;
  void decide(At& at, std::size_t block, const Terms& terms, VisibilityEstimate& d) const;
  bool clamps_negative() const { return settings_.clamp_negative; }
  std::vector<std::pair<std::string, double>> statistics() const { return points_.statistics(); }

 private:
  ProbabilisticVisibilitySettings settings_;
  CachePoints points_;
  float other_rays_ = 0;
};

/// visibility: interpolated. The estimate is q, without shadow rays.
class InterpolatedVisibility : public VisibilityBase {
 public:
  explicit InterpolatedVisibility(const InterpolatedVisibilitySettings& settings)
      : points_(settings.cache_points, settings.neighbours, CachePoints::Keep::visibilities,
                settings.cache_lights) {}

  Counters begin(const LightPass& pass) { return points_.build(pass); }
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
  std::vector<std::pair<std::string, double>> statistics() const { return points_.statistics(); }

 private:
  CachePoints points_;
};

}  // namespace lacuna
