#pragma once

#include <cstdint>

namespace lacuna {

/// Counts of samples and rays, for rates and reports. Summed over tiles in a fixed order.
struct Counters {
  std::uint64_t samples = 0;      ///< paths from the eye or from a light
  std::uint64_t rays = 0;         ///< nearest-hit queries
  std::uint64_t shadow_rays = 0;  ///< occlusion queries
  std::uint64_t negative = 0;     ///< contributions below zero (legal; counted)
  std::uint64_t rejected = 0;     ///< contributions that were not finite (dropped; a defect)

  Counters& operator+=(const Counters& o) {
    samples += o.samples;
    rays += o.rays;
    shadow_rays += o.shadow_rays;
    negative += o.negative;
    rejected += o.rejected;
    return *this;
  }
};

}  // namespace lacuna
