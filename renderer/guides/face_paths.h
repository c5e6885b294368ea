#pragma once

#include <functional>
#include <span>

#include "renderer/path/contexts.h"
#include "renderer/path/counters.h"

namespace lacuna {

/// Estimates the luminance of the light that arrives from ahead along each of light.size() rays, by
/// one path of at most `edges` edges each: the BSDF is sampled, with next event estimation.
/// `ray(i, rng)` returns ray i, of unit direction; several threads call it. The rays start in the
/// empty space, on no surface. Throws IterationStopped.
Counters arriving_light(const IterationContext& context, int edges,
                        const std::function<Ray(std::size_t, Rng&)>& ray, std::span<float> light);

}  // namespace lacuna
