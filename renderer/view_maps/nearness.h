#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "analysis/geometry/simd.h"

namespace lacuna {

/// Distances in 16 bits: scale / distance as a half float. Distances below 1/4,000,000 of the
/// scene's size are clamped to that.
struct Nearness {
  static constexpr float largest = 65504;  ///< the largest half float
  float scale = 0;  ///< a code is scale / distance; code 0: infinite distance

  /// `extent`: the largest distance. Its code is 1/64, well above the smallest half float.
  static Nearness within(float extent) { return {extent / 64}; }
  std::uint16_t encode(float distance) const {
    return _cvtss_sh(std::min(scale / distance, largest), _MM_FROUND_TO_NEAREST_INT);
  }
  /// Encodes all `distances` into the array `to`.
  void encode(std::span<const float> distances, std::uint16_t* to) const {
    std::size_t i = 0;
    for (; i + 8 <= distances.size(); i += 8) {
      const Float8 codes = Float8(scale) / Float8::load_unaligned(&distances[i]);
      min(codes, largest).store_half(to + i);
    }
    for (; i < distances.size(); ++i) to[i] = encode(distances[i]);
  }
  /// scale / distance
  static float decode(std::uint16_t code) { return _cvtsh_ss(code); }
};

}  // namespace lacuna
