#include "renderer/core/rng.h"

#include <immintrin.h>

namespace lacuna {

void Rng::refill() {
  used_ = 0;
  if (source_ == Source::sobol) {
    sobol_.words(counter_[0]++, numbers_);
  } else if (source_ == Source::kept) [[unlikely]] {
    words_->next(numbers_);
  } else {
    refill_by_philox();
  }
}

void Rng::refill_by_philox() {
  const __m256i low = _mm256_set1_epi64x(0xffffffff);
  const auto spread = [](std::uint32_t v) { return _mm256_set1_epi64x(v); };
  __m256i c0 = _mm256_add_epi64(spread(counter_[0]), _mm256_setr_epi64x(0, 1, 2, 3));
  __m256i c1 = spread(counter_[1]);
  __m256i c2 = spread(counter_[2]);
  __m256i c3 = spread(counter_[3]);
  std::uint32_t k0 = key_[0];
  std::uint32_t k1 = key_[1];
  for (int round = 0; round < 10; ++round) {
    const __m256i p0 = _mm256_mul_epu32(c0, spread(multiplier_0));
    const __m256i p1 = _mm256_mul_epu32(c2, spread(multiplier_1));
    c0 = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(p1, 32), c1), spread(k0));
    c2 = _mm256_xor_si256(_mm256_xor_si256(_mm256_srli_epi64(p0, 32), c3), spread(k1));
    c1 = _mm256_and_si256(p1, low);
    c3 = _mm256_and_si256(p0, low);
    k0 += weyl_0;
    k1 += weyl_1;
  }
  // Interleaves words 0 and 1, and 2 and 3, of each block; then brings each block's halves
  // together.
  const __m256i w01 = _mm256_or_si256(c0, _mm256_slli_epi64(c1, 32));
  const __m256i w23 = _mm256_or_si256(c2, _mm256_slli_epi64(c3, 32));
  const __m256i even = _mm256_unpacklo_epi64(w01, w23);  // blocks 0 and 2
  const __m256i odd = _mm256_unpackhi_epi64(w01, w23);   // blocks 1 and 3
  auto* out = reinterpret_cast<__m256i*>(numbers_.data());
  _mm256_store_si256(out, _mm256_permute2x128_si256(even, odd, 0x20));
  _mm256_store_si256(out + 1, _mm256_permute2x128_si256(even, odd, 0x31));
  counter_[0] += 4;
}

}  // namespace lacuna
