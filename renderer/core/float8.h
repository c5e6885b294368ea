#pragma once

#include <immintrin.h>

namespace lacuna {

// Eight floats in a register. std::experimental::simd is not used: in long loops GCC 12 calls a
// function wherever it broadcasts a scalar, and a picture with probabilistic visibility takes a
// third more time.

/// The result of a comparison of eight floats.
struct Mask8 {
  __m256 v;
};
inline Mask8 operator&&(Mask8 a, Mask8 b) { return {_mm256_and_ps(a.v, b.v)}; }
inline bool any_of(Mask8 m) { return _mm256_movemask_ps(m.v) != 0; }
/// Bit i is element i.
inline unsigned bits_of(Mask8 m) { return static_cast<unsigned>(_mm256_movemask_ps(m.v)); }

struct Float8 {
  __m256 v;

  Float8() : v(_mm256_setzero_ps()) {}
  Float8(__m256 values) : v(values) {}           // NOLINT(google-explicit-constructor)
  Float8(float all) : v(_mm256_set1_ps(all)) {}  // NOLINT(google-explicit-constructor)
  /// From 32-byte aligned memory.
  static Float8 load(const float* from) { return _mm256_load_ps(from); }
  void store(float* to) const { _mm256_store_ps(to, v); }
};

inline Float8 operator+(Float8 a, Float8 b) { return _mm256_add_ps(a.v, b.v); }
inline Float8 operator-(Float8 a, Float8 b) { return _mm256_sub_ps(a.v, b.v); }
inline Float8 operator*(Float8 a, Float8 b) { return _mm256_mul_ps(a.v, b.v); }
inline Float8 operator/(Float8 a, Float8 b) { return _mm256_div_ps(a.v, b.v); }
inline Float8 operator-(Float8 a) { return _mm256_xor_ps(a.v, _mm256_set1_ps(-0.0F)); }
// A comparison with NaN is false.
inline Mask8 operator>(Float8 a, Float8 b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GT_OQ)}; }
inline Mask8 operator>=(Float8 a, Float8 b) { return {_mm256_cmp_ps(a.v, b.v, _CMP_GE_OQ)}; }
/// Where `m` holds `a`, else `b`.
inline Float8 select(Mask8 m, Float8 a, Float8 b) { return _mm256_blendv_ps(b.v, a.v, m.v); }
/// Where `m` holds `a`, else 0, whatever `a` is there.
inline Float8 keep_where(Mask8 m, Float8 a) { return _mm256_and_ps(m.v, a.v); }
inline Float8 min(Float8 a, Float8 b) { return _mm256_min_ps(a.v, b.v); }
inline Float8 max(Float8 a, Float8 b) { return _mm256_max_ps(a.v, b.v); }
inline Float8 sqrt(Float8 a) { return _mm256_sqrt_ps(a.v); }
inline Float8 ceil(Float8 a) { return _mm256_ceil_ps(a.v); }
inline Float8 floor(Float8 a) { return _mm256_floor_ps(a.v); }
inline Float8 abs(Float8 a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0F), a.v); }
/// The sum of all elements, in a fixed order.
inline float sum(Float8 a) {
  const __m128 four = _mm_add_ps(_mm256_castps256_ps128(a.v), _mm256_extractf128_ps(a.v, 1));
  const __m128 two = _mm_add_ps(four, _mm_movehl_ps(four, four));
  return _mm_cvtss_f32(_mm_add_ss(two, _mm_movehdup_ps(two)));
}

/// Eight whole numbers of 32 bits.
struct Int8 {
  __m256i v;

  Int8(__m256i values) : v(values) {}  // NOLINT(google-explicit-constructor)
  explicit Int8(int all) : v(_mm256_set1_epi32(all)) {}
  /// To 32-byte aligned memory.
  void store(int* to) const { _mm256_store_si256(reinterpret_cast<__m256i*>(to), v); }
};
inline Int8 operator+(Int8 a, Int8 b) { return _mm256_add_epi32(a.v, b.v); }
inline Int8 operator*(Int8 a, Int8 b) { return _mm256_mullo_epi32(a.v, b.v); }
inline Int8 min(Int8 a, Int8 b) { return _mm256_min_epi32(a.v, b.v); }
inline Int8 max(Int8 a, Int8 b) { return _mm256_max_epi32(a.v, b.v); }
inline Int8 keep_where(Mask8 m, Int8 a) { return _mm256_and_si256(_mm256_castps_si256(m.v), a.v); }
/// Rounded towards 0; the lowest integer where the result is out of range or NaN.
inline Int8 truncated(Float8 a) { return _mm256_cvttps_epi32(a.v); }

/// Eight directions, or colours.
struct Float8x3 {
  Float8 x, y, z;

  Float8x3 operator+(const Float8x3& o) const { return {x + o.x, y + o.y, z + o.z}; }
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

}  // namespace lacuna
