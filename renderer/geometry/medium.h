#pragma once

#include <cmath>
#include <limits>

#include "renderer/core/vec.h"

namespace lacuna {

/// The absorbing inside of a solid (KHR_materials_volume).
struct Medium {
  Rgb extinction{0, 0, 0};  ///< 1 / scene unit, >= 0; all by absorption

  bool operator==(const Medium&) const = default;
};

inline constexpr float infinite_distance = std::numeric_limits<float>::infinity();

/// The transmittance of a segment of that length by Beer and Lambert's law, from what lies on its
/// side of the surfaces at its two ends: null is no medium. Two different media are one within the
/// other, or overlap: both absorb.
inline Rgb transmittance(const Medium* a, const Medium* b, float distance) {
  Rgb extinction(0, 0, 0);
  if (a != nullptr) extinction += a->extinction;
  if (b != nullptr && b != a) extinction += b->extinction;
  const auto channel = [&](float e) { return e > 0 ? std::exp(-e * distance) : 1.0F; };
  return {channel(extinction.x), channel(extinction.y), channel(extinction.z)};
}

}  // namespace lacuna
