#pragma once

#include <immintrin.h>

namespace lacuna {

/// Base-2 logarithm of eight normal numbers above 0, to within 2e-7 of itself: with the mantissa m
/// in [sqrt(1/2), sqrt(2)), log m = 2 atanh((m - 1) / (m + 1)), of which five terms are enough.
inline __m256 log2_8(__m256 x) {
  const __m256i bits = _mm256_castps_si256(x);
  // Counted from the exponent of sqrt(1/2), so that the mantissa lies around 1.
  const __m256i from = _mm256_sub_epi32(bits, _mm256_set1_epi32(0x3f3504f3));
  const __m256i exponent = _mm256_srai_epi32(from, 23);
  const __m256 m = _mm256_castsi256_ps(_mm256_sub_epi32(bits, _mm256_slli_epi32(exponent, 23)));
  const __m256 one = _mm256_set1_ps(1);
  const __m256 z = _mm256_div_ps(_mm256_sub_ps(m, one), _mm256_add_ps(m, one));
  const __m256 z2 = _mm256_mul_ps(z, z);
  constexpr float scale = 2.88539008F;  // 2 / ln 2
  __m256 sum = _mm256_set1_ps(scale / 9);
  for (const float term : {scale / 7, scale / 5, scale / 3, scale}) {
    sum = _mm256_add_ps(_mm256_mul_ps(sum, z2), _mm256_set1_ps(term));
  }
  return _mm256_add_ps(_mm256_cvtepi32_ps(exponent), _mm256_mul_ps(sum, z));
}

/// 2^x of eight numbers up to 127, to within 3e-7 of itself; below -126: 0.
inline __m256 exp2_8(__m256 x) {
  const __m256 least = _mm256_set1_ps(-126);
  const __m256 inside = _mm256_cmp_ps(x, least, _CMP_GE_OQ);
  x = _mm256_max_ps(x, least);
  const __m256 whole = _mm256_round_ps(x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
  const __m256 part = _mm256_sub_ps(x, whole);  // in [-1/2, 1/2]
  __m256 sum = _mm256_set1_ps(1.54035304e-4F);  // (ln 2)^k / k! for k = 6, 5, ...
  for (const float term :
       {1.33335581e-3F, 9.61812911e-3F, 5.55041087e-2F, 2.40226507e-1F, 6.93147181e-1F, 1.0F}) {
    sum = _mm256_add_ps(_mm256_mul_ps(sum, part), _mm256_set1_ps(term));
  }
  const __m256i exponent = _mm256_slli_epi32(_mm256_cvtps_epi32(whole), 23);
  const __m256 power = _mm256_castsi256_ps(_mm256_add_epi32(_mm256_castps_si256(sum), exponent));
  return _mm256_and_ps(power, inside);
}

/// c^s of eight numbers in [0, 1], s >= 0; 0 where c is 0 or denormal, also for s = 0.
inline __m256 power8(__m256 c, float s) {
  const __m256 least = _mm256_set1_ps(0x1p-126F);
  const __m256 above = _mm256_cmp_ps(c, least, _CMP_GE_OQ);
  const __m256 power = exp2_8(_mm256_mul_ps(_mm256_set1_ps(s), log2_8(_mm256_max_ps(c, least))));
  return _mm256_and_ps(power, above);
}

}  // namespace lacuna
