#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

/// Where the random numbers of eye paths and light paths come from.
enum class Sampler { sobol, independent };

template <>
struct EnumTable<Sampler> {
  static constexpr std::array<EnumValue<Sampler>, 2> values{{
      {Sampler::sobol, "sobol",
       "Owen-scrambled Sobol' points, padded from pairs of dimensions (Burley 2020): the samples "
       "of "
       "a pixel, and the light paths of a picture, are spread evenly; even and odd iterations are "
       "two independent randomisations. Markov chains and what is drawn among light vertices stay "
       "independent"},
      {Sampler::independent, "independent", "all independent"},
  }};
};

}  // namespace lacuna
