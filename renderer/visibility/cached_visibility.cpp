#include "renderer/visibility/cached_visibility.h"

#include "renderer/settings/visibility_settings.h"

namespace lacuna {

Counters ProbabilisticVisibility::begin(const LightPass& pass) {
  other_rays_ = eye_rays_per_light(pass);
  return points_.build(pass);
}

ProbabilisticVisibility::At ProbabilisticVisibility::at(const ShadingPoint& point,
                                                        const IterationContext& context) const {
  const CachePoints::Neighbours neighbours = points_.nearest(point);
  return {neighbours,
          {.k = other_rays_ + static_cast<float>(settings_.term_cost),
           .c = 1,
           .least = static_cast<float>(settings_.epsilon_probability),
           .over_sigma = 1 / points_.deviation(settings_.variance, point, neighbours)},
          {context.seed, context.iteration, point.pixel, Rng::Purpose::visibility}};
}

void ProbabilisticVisibility::decide(At& at, std::size_t block, const Terms& terms,
                                     VisibilityEstimate& d) const {
  const std::uint64_t tested = points_.expected(at.neighbours, block, d.untested);  // q
  const auto least = static_cast<float>(settings_.epsilon_variance);
  constexpr float unknown =
      std::numeric_limits<float>::infinity();  // lights of unknown visibility are tested
  const TestProbability chance = at.chance;
  TestSampler sampler;
  for (int k = 0; k < Lanes::groups; ++k) {
    const Float8 q = d.untested.eight(k);
    const Float8 t = terms.luminance.eight(k);
    const Mask8 is_tested = mask_from_bits(static_cast<unsigned>(tested >> (8 * k) & 0xff));
    const Float8 var = select(is_tested, max(least, q * (1 - q)), unknown);
    sampler.set(k, chance.of(t, var, terms.weight), t);
  }
  d.tests = sampler.sample(settings_.draws, at.rng);
  for_each_bit(d.tests, [&](int i) {
    const float x = sampler.probability(i);
    d.untested[i] *= (x - 1) / x;
    d.gain[i] = 1 / x;
  });
}

}  // namespace lacuna
