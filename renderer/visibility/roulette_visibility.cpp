#include "renderer/visibility/roulette_visibility.h"

#include "renderer/settings/visibility_settings.h"

namespace lacuna {

Counters RouletteVisibility::begin(const LightPass& pass) {
  other_rays_ = eye_rays_per_light(pass);
  return points_.build(pass);
}

RouletteVisibility::At RouletteVisibility::at(const ShadingPoint& point,
                                              const IterationContext& context) const {
  const bool derived = settings_.rule == RouletteRule::derived;
  const auto neighbours = settings_.variance == VarianceOf::picture ? CachePoints::Neighbours{}
                                                                    : points_.nearest(point);
  const float other_time = other_rays_ + static_cast<float>(settings_.term_cost);
  return {{.k = derived ? other_time : other_time + 1,
           .c = derived ? 1.0F : 0.0F,
           .least = static_cast<float>(settings_.epsilon_probability),
           .over_sigma = 1 / points_.deviation(settings_.variance, point, neighbours)},
          {context.seed, context.iteration, point.pixel, Rng::Purpose::visibility}};
}

void RouletteVisibility::decide(At& at, std::size_t, const Terms& terms,
                                VisibilityEstimate& d) const {
  const TestProbability chance = at.chance;
  TestSampler sampler;
  for (int k = 0; k < Lanes::groups; ++k) {
    const Float8 t = terms.luminance.eight(k);
    sampler.set(k, chance.of(t, 1, terms.weight), t);
  }
  d.tests = sampler.sample(settings_.draws, at.rng);
  d.untested.v.fill(0);
  for_each_bit(d.tests, [&](int i) { d.gain[i] = 1 / sampler.probability(i); });
}

}  // namespace lacuna
