#pragma once

#include <immintrin.h>

#include <algorithm>
#include <cstdint>
#include <span>

namespace lacuna {

/// Distances in sixteen bits: scale / distance as a half float. Distances below 1/4,000,000 of the
/// scene's size are stored as that.
struct Nearness {
  float scale = 0;  ///< a code is scale / distance; code 0: infinitely far

  /// `extent`: the largest distance. Its code is 1/64, well above the smallest half float.
  static Nearness within(float extent) { return {extent / 64}; }
  std::uint16_t encode(float distance) const {
    return _cvtss_sh(std::min(scale / distance, 65504.0F), _MM_FROUND_TO_NEAREST_INT);
  }
  /// Encodes all `distances` to the array `to`.
  void encode(std::span<const float> distances, std::uint16_t* to) const {
    const __m256 most = _mm256_set1_ps(65504.0F);
    std::size_t i = 0;
    for (; i + 8 <= distances.size(); i += 8) {
      const __m256 codes = _mm256_div_ps(_mm256_set1_ps(scale), _mm256_loadu_ps(&distances[i]));
      _mm_storeu_si128(reinterpret_cast<__m128i*>(to + i),
                       _mm256_cvtps_ph(_mm256_min_ps(codes, most), _MM_FROUND_TO_NEAREST_INT));
    }
    for (; i < distances.size(); ++i) to[i] = encode(distances[i]);
  }
  /// scale / distance
  static float decode(std::uint16_t code) { return _cvtsh_ss(code); }
};

}  // namespace lacuna
