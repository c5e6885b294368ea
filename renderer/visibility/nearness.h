#pragma once

#include <immintrin.h>

#include <algorithm>
#include <cstdint>

namespace lacuna {

/// Distances in sixteen bits: 1 / distance as half floats, of which what is nearer than 1/4,000,000
/// of the scene's size is taken to be there.
struct Nearness {
  float scale = 0;  ///< codes stand for scale / distance; 0: infinitely far

  /// `extent`: no distance is above it. The far end is 1/64 or more, well above the smallest half.
  static Nearness within(float extent) { return {extent / 64}; }
  std::uint16_t encode(float distance) const {
    return _cvtss_sh(std::min(scale / distance, 65504.0F), _MM_FROUND_TO_NEAREST_INT);
  }
  /// scale / distance
  static float decode(std::uint16_t code) { return _cvtsh_ss(code); }
};

}  // namespace lacuna
