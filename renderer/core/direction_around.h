#pragma once

#include <cmath>

#include "renderer/core/frame.h"
#include "renderer/core/sampling.h"

namespace lacuna {

/// The unit direction whose angle to unit `axis` has the cosine 1 - `versine`, `versine` in [0, 2],
/// at the azimuth 2 pi `u`. Near the axis the versine is more precise than the cosine.
inline V3f direction_around(const V3f& axis, double versine, float u) {
  const auto sine = static_cast<float>(std::sqrt(versine * (2 - versine)));
  const float phi = 2 * pi * u;
  return Frame(axis).to_world(
      {sine * std::cos(phi), sine * std::sin(phi), static_cast<float>(1 - versine)});
}

}  // namespace lacuna
