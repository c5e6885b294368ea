#pragma once

#include "renderer/settings/visibility_settings.h"
#include "renderer/visibility/test_probability.h"
#include "renderer/visibility/visibility_base.h"

namespace lacuna {

/// visibility: roulette. A light is tested with probability p: the estimate is v / p if tested,
/// else 0. p depends on the variance of contributions, which is measured at a few shading points.
class RouletteVisibility : public VisibilityBase {
 public:
  explicit RouletteVisibility(const RouletteVisibilitySettings& settings)
      : settings_(settings),
        points_(settings.cache_points, settings.neighbours, CachePoints::Keep::variances) {}

  Counters begin(const LightPass& pass);
  struct At {
    TestProbability chance;
    Rng rng;
  };
  At at(const ShadingPoint& point, const IterationContext& context) const;
  void decide(At& at, std::size_t block, const Terms& terms, VisibilityEstimate& d) const;
  std::vector<std::pair<std::string, double>> statistics() const { return points_.statistics(); }

 private:
  RouletteVisibilitySettings settings_;
  CachePoints points_;
  float other_rays_ = 0;  // eye rays per light
};

}  // namespace lacuna
