#include "renderer/core/sobol.h"

#include <immintrin.h>

namespace lacuna {
namespace {

__m256i spread(std::uint32_t v) { return _mm256_set1_epi32(static_cast<int>(v)); }
__m256i times(__m256i v, std::uint32_t factor) { return _mm256_mullo_epi32(v, spread(factor)); }
__m256i fold(__m256i v, int shift) { return _mm256_xor_si256(v, _mm256_srli_epi32(v, shift)); }

/// A bijection that mixes all bits (the constants of Wellons' "lowbias32").
__m256i hash(__m256i v) {
  v = times(fold(v, 16), 0x7feb352d);
  v = times(fold(v, 15), 0x846ca68b);
  return fold(v, 16);
}

/// Owen's nested scrambling of reversed bits: whether a bit flips depends on the bits below it
/// only (Laine and Karras 2011, with the constants of Vegdahl 2021).
__m256i permute(__m256i v, __m256i seed) {
  const auto flip = [](__m256i x, std::uint32_t even) {
    return _mm256_xor_si256(x, times(x, even));
  };
  v = _mm256_add_epi32(flip(v, 0x3d20adea), seed);
  v = _mm256_mullo_epi32(v, _mm256_or_si256(_mm256_srli_epi32(seed, 16), spread(1)));
  return flip(flip(v, 0x05526c56), 0x53a22864);
}

__m256i reverse_bits(__m256i v) {
  const __m256i nibble = spread(0x0f0f0f0f);
  const __m256i reversed =
      _mm256_setr_epi8(0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15,  //
                       0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15);
  const __m256i bytes = _mm256_setr_epi8(3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12,  //
                                         3, 2, 1, 0, 7, 6, 5, 4, 11, 10, 9, 8, 15, 14, 13, 12);
  const __m256i low = _mm256_shuffle_epi8(reversed, _mm256_and_si256(v, nibble));
  const __m256i high =
      _mm256_shuffle_epi8(reversed, _mm256_and_si256(_mm256_srli_epi32(v, 4), nibble));
  return _mm256_shuffle_epi8(_mm256_or_si256(_mm256_slli_epi32(low, 4), high), bytes);
}

/// The second dimension of Sobol', with reversed bits: the index times Pascal's triangle modulo
/// 2, whose element (r, c) is 1 if the bits of r are a subset of those of c.
__m256i second_reversed(__m256i index) {
  const auto step = [](__m256i v, int shift, std::uint32_t mask) {
    return _mm256_xor_si256(v, _mm256_and_si256(_mm256_srli_epi32(v, shift), spread(mask)));
  };
  index = step(index, 1, 0x55555555);
  index = step(index, 2, 0x33333333);
  index = step(index, 4, 0x0f0f0f0f);
  index = step(index, 8, 0x00ff00ff);
  return step(index, 16, 0x0000ffff);
}

}  // namespace

void SobolSample::words(std::uint32_t block, Words& out) const {
  const __m256i lane = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
  const __m256i pair = _mm256_add_epi32(_mm256_set1_epi32(static_cast<int>(8 * block)), lane);
  // A seed for each pair, from multiples of the golden ratio and both halves of the key.
  const __m256i own = hash(_mm256_add_epi32(spread(key_[0]), times(pair, 0x9e3779b9)));
  const __m256i seed_x = hash(_mm256_xor_si256(own, spread(key_[1])));
  const __m256i seed_y = hash(_mm256_add_epi32(seed_x, spread(key_[1] ^ 0x85ebca6b)));
  const __m256i index = reverse_bits(permute(spread(reversed_), own));
  const __m256i x = reverse_bits(permute(index, seed_x));
  const __m256i y = reverse_bits(permute(second_reversed(index), seed_y));
  const __m256i low = _mm256_unpacklo_epi32(x, y);   // pairs 0, 1 and 4, 5
  const __m256i high = _mm256_unpackhi_epi32(x, y);  // pairs 2, 3 and 6, 7
  auto* to = reinterpret_cast<__m256i*>(out.data());
  _mm256_store_si256(to, _mm256_permute2x128_si256(low, high, 0x20));
  _mm256_store_si256(to + 1, _mm256_permute2x128_si256(low, high, 0x31));
}

}  // namespace lacuna
