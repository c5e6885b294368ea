#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

/// The source of the random numbers of eye paths and light paths.
enum class Sampler { sobol, independent };

template <>
struct EnumTable<Sampler> {
  static constexpr std::array<EnumValue<Sampler>, 2> values{{
      {Sampler::sobol, "sobol",
       "Owen-scrambled Sobol' points, padded from pairs of dimensions (Burley 2020): the samples "
       "of a pixel, and the light paths of a picture, are stratified; even and odd iterations are "
       "two independent randomisations. Markov chains, and the sampling of light vertices, use "
       "independent numbers"},
      {Sampler::independent, "independent", "all numbers are independent"},
  }};
};

}  // namespace lacuna
