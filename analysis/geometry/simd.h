#pragma once

#include <immintrin.h>

#include <array>
#include <cstdint>

namespace lacuna {

// Eight numbers in a register. std::experimental::simd is not used: in long loops GCC 12 calls a
// function for each broadcast of a scalar, and a picture with probabilistic visibility takes a
// third more time.

/// The result of a comparison of eight floats.
struct Mask8 {
  __m256 v;
};
inline Mask8 operator&&(Mask8 a, Mask8 b) { return {_mm256_and_ps(a.v, b.v)}; }
inline bool any(Mask8 m) { return _mm256_movemask_ps(m.v) != 0; }
/// Bit i is element i.
inline unsigned movemask(Mask8 m) { return static_cast<unsigned>(_mm256_movemask_ps(m.v)); }
/// The inverse of movemask(), of the lowest eight bits.
inline Mask8 mask_from_bits(unsigned bits) {
  const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), lane);
  return {_mm256_castsi256_ps(_mm256_cmpeq_epi32(set, lane))};
}

struct Float8 {
  __m256 v;

  Float8() : v(_mm256_setzero_ps()) {}
  Float8(__m256 values) : v(values) {}           // NOLINT(google-explicit-constructor)
  Float8(float all) : v(_mm256_set1_ps(all)) {}  // NOLINT(google-explicit-constructor)
  /// From 32-byte aligned memory.
  static Float8 load(const float* from) { return _mm256_load_ps(from); }
  void store(float* to) const { _mm256_store_ps(to, v); }
  static Float8 load_unaligned(const float* from) { return _mm256_loadu_ps(from); }
  void store_unaligned(float* to) const { _mm256_storeu_ps(to, v); }
  /// Eight half floats at any address; stores round to the nearest.
  static Float8 load_half(const std::uint16_t* from) {
    return _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(from)));
  }
  void store_half(std::uint16_t* to) const {
    _mm_storeu_si128(reinterpret_cast<__m128i*>(to), _mm256_cvtps_ph(v, _MM_FROUND_TO_NEAREST_INT));
  }
};

inline Float8 operator+(Float8 a, Float8 b) { return _mm256_add_ps(a.v, b.v); }
inline Float8 operator-(Float8 a, Float8 b) { return _mm256_sub_ps(a.v, b.v); }
inline Float8 operator*(Float8 a, Float8 b) { return _mm256_mul_ps(a.v, b.v); }
inline Float8 operator/(Float8 a, Float8 b) { return _mm256_div_ps(a.v, b.v); }
inline Float8 operator-(Float8 a) { return _mm256_xor_ps(a.v, _mm256_set1_ps(-0.0F)); }
// A comparison with NaN is false.
inline Mask8 operator>(Float8 a, Float8 b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)}; }
inline Mask8 operator>=(Float8 a, Float8 b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GE_OQ)}; }
/// `a` where `m` holds, else `b`.
inline Float8 select(Mask8 m, Float8 a, Float8 b) { return _mm256_blendv_ps(b.v, a.v, m.v); }
/// `a` where `m` holds, else 0, also where `a` is NaN.
inline Float8 keep_where(Mask8 m, Float8 a) { return _mm256_and_ps(m.v, a.v); }
inline Float8 min(Float8 a, Float8 b) { return _mm256_min_ps(a.v, b.v); }
inline Float8 max(Float8 a, Float8 b) { return _mm256_max_ps(a.v, b.v); }
inline Float8 sqrt(Float8 a) { return _mm256_sqrt_ps(a.v); }
inline Float8 ceil(Float8 a) { return _mm256_ceil_ps(a.v); }
inline Float8 floor(Float8 a) { return _mm256_floor_ps(a.v); }
inline Float8 abs(Float8 a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.v); }
inline Float8 round(Float8 a) {
  return _mm256_round_ps(a.v, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
}
/// The sum of all elements, in a fixed order.
inline float reduce_add(Float8 a) {
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
}

/// Eight 32-bit integers, which wrap around.
struct Int8 {
  __m256i v;

  Int8(__m256i values) : v(values) {}  // NOLINT(google-explicit-constructor)
  explicit Int8(int all) : v(_mm256_set1_epi32(all)) {}
  /// To 32-byte aligned memory.
  void store(int* to) const { _mm256_store_si256(reinterpret_cast<__m256i*>(to), v); }
  static Int8 load_unaligned(const std::uint32_t* from) {
    return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(from));
  }
  void store_unaligned(std::uint32_t* to) const {
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(to), v);
  }
};
inline Int8 operator+(Int8 a, Int8 b) { return _mm256_add_epi32(a.v, b.v); }
inline Int8 operator-(Int8 a, Int8 b) { return _mm256_sub_epi32(a.v, b.v); }
inline Int8 operator&(Int8 a, Int8 b) { return _mm256_and_si256(a.v, b.v); }
inline Int8 operator<<(Int8 a, int bits) { return _mm256_slli_epi32(a.v, bits); }
inline Int8 operator>>(Int8 a, int bits) { return _mm256_srai_epi32(a.v, bits); }
inline Int8 operator*(Int8 a, Int8 b) { return _mm256_mullo_epi32(a.v, b.v); }
inline Int8 min(Int8 a, Int8 b) { return _mm256_min_epi32(a.v, b.v); }
inline Int8 max(Int8 a, Int8 b) { return _mm256_max_epi32(a.v, b.v); }
inline Int8 min_unsigned(Int8 a, Int8 b) { return _mm256_min_epu32(a.v, b.v); }
inline Int8 max_unsigned(Int8 a, Int8 b) { return _mm256_max_epu32(a.v, b.v); }
inline bool all_equal(Int8 a, Int8 b) {
  return _mm256_movemask_epi8(_mm256_cmpeq_epi32(a.v, b.v)) == -1;
}
inline Int8 keep_where(Mask8 m, Int8 a) { return _mm256_and_si256(_mm256_castps_si256(m.v), a.v); }
/// Rounded towards 0; the lowest integer where the result is out of range or NaN.
inline Int8 truncate(Float8 a) { return _mm256_cvttps_epi32(a.v); }
inline Int8 round_to_int(Float8 a) { return _mm256_cvtps_epi32(a.v); }
inline Float8 to_float(Int8 a) { return _mm256_cvtepi32_ps(a.v); }
/// The same bits.
inline Int8 as_int(Float8 a) { return _mm256_castps_si256(a.v); }
inline Float8 as_float(Int8 a) { return _mm256_castsi256_ps(a.v); }
/// 0, 1, ..., 7
inline Int8 lane_numbers() { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }
/// a[order[i]] for each i; the lowest three bits of `order` count.
inline Float8 permute(Float8 a, Int8 order) { return _mm256_permutevar8x32_ps(a.v, order.v); }
inline Int8 permute(Int8 a, Int8 order) { return _mm256_permutevar8x32_epi32(a.v, order.v); }

/// For each byte the indices of its set bits, ascending, one per byte.
inline constexpr std::array<std::uint64_t, 256> set_lanes = [] {
  std::array<std::uint64_t, 256> table{};
  for (unsigned bits = 0; bits < 256; ++bits) {
    int at = 0;
    for (unsigned i = 0; i < 8; ++i) {
      if ((bits >> i & 1) != 0) table[bits] |= std::uint64_t{i} << (8 * at++);
    }
  }
  return table;
}();
/// For permute(): moves the elements whose bits are set to the front.
inline Int8 to_front(unsigned bits) {
  return _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(set_lanes[bits])));
}

/// from[i] for each of eight indices.
inline Float8 gather(const float* from, Int8 i) { return _mm256_i32gather_ps(from, i.v, 4); }

/// Eight directions, or colours.
struct Float8x3 {
  Float8 x, y, z;

  Float8x3 operator+(const Float8x3& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Float8x3 operator-(const Float8x3& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Float8x3 operator*(Float8 s) const { return {x * s, y * s, z * s}; }
};
inline Float8 dot(const Float8x3& a, const Float8x3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Float8 length2(const Float8x3& a) { return dot(a, a); }
inline Float8x3 cross(const Float8x3& a, const Float8x3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Float8x3 keep_where(Mask8 m, const Float8x3& a) {
  return {keep_where(m, a.x), keep_where(m, a.y), keep_where(m, a.z)};
}
inline Float8x3 select(Mask8 m, const Float8x3& a, const Float8x3& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

}  // namespace lacuna
