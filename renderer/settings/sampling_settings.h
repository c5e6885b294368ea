#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

/// How many samples the pixels of a picture get.
enum class Sampling { uniform, adaptive };

template <>
struct EnumTable<Sampling> {
  static constexpr std::array<EnumValue<Sampling>, 2> values{{
      {Sampling::uniform, "uniform", "as many everywhere"},
      {Sampling::adaptive, "adaptive",
       "more where the variance is larger, by blocks of 16 pixels or more: an iteration has at "
       "least 8 samples a pixel on average, and numbers are fixed before they are drawn"},
  }};
};

}  // namespace lacuna
