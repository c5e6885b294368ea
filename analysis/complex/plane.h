#pragma once

#include <immintrin.h>

#include <cstdint>

#include "analysis/geometry/bit_grid.h"

namespace lacuna {

/// One bit for each of the 8 x 8 x 8 cells of a block, in registers: lanes z = 0..3 and 4..7, byte
/// y, bit x (the layout of BitBlock).
struct Plane {
  using Half = std::uint64_t __attribute__((vector_size(32)));
  Half lo, hi;

  Plane() = default;
  Plane(Half l, Half h) : lo(l), hi(h) {}
  // Member by member: GCC copies an aggregate through the stack in quarters, which more than halves
  // the speed of the collapse.
  Plane(const Plane& o) : lo(o.lo), hi(o.hi) {}
  Plane& operator=(const Plane& o) {
    lo = o.lo;
    hi = o.hi;
    return *this;
  }

  static Plane zero() { return {Half{}, Half{}}; }
  static Plane of(const BitBlock& b) {
    return {Half{b.z[0], b.z[1], b.z[2], b.z[3]}, Half{b.z[4], b.z[5], b.z[6], b.z[7]}};
  }
  BitBlock bits() const { return {{lo[0], lo[1], lo[2], lo[3], hi[0], hi[1], hi[2], hi[3]}}; }
  bool any() const {
    const auto h = reinterpret_cast<__m256i>(lo | hi);
    return _mm256_testz_si256(h, h) == 0;
  }
};
static_assert(sizeof(Plane) == sizeof(BitBlock) && alignof(Plane) <= alignof(BitBlock));

inline Plane operator&(Plane a, Plane b) { return {a.lo & b.lo, a.hi & b.hi}; }
inline Plane operator|(Plane a, Plane b) { return {a.lo | b.lo, a.hi | b.hi}; }
inline Plane operator^(Plane a, Plane b) { return {a.lo ^ b.lo, a.hi ^ b.hi}; }
inline Plane operator~(Plane a) { return {~a.lo, ~a.hi}; }
inline Plane& operator&=(Plane& a, Plane b) { return a = a & b; }
inline Plane& operator|=(Plane& a, Plane b) { return a = a | b; }

/// The bits of the highest slice of a block along an axis.
template <int axis>
inline Plane high_slice() {
  constexpr std::uint64_t w = axis == 0   ? 0x8080808080808080u
                              : axis == 1 ? 0xff00000000000000u
                                          : ~std::uint64_t{0};
  if constexpr (axis == 2) return {Plane::Half{}, Plane::Half{0, 0, 0, w}};
  return {Plane::Half{w, w, w, w}, Plane::Half{w, w, w, w}};
}

/// At every cell c the bit of c - e_axis; `below` is the block before `own` along the axis.
template <int axis>
inline Plane from_low(Plane own, Plane below) {
  using Half = Plane::Half;
  if constexpr (axis == 0) {
    constexpr std::uint64_t rest = 0x7f7f7f7f7f7f7f7fu, first = 0x0101010101010101u;
    return {((own.lo & rest) << 1) | ((below.lo >> 7) & first),
            ((own.hi & rest) << 1) | ((below.hi >> 7) & first)};
  } else if constexpr (axis == 1) {
    return {(own.lo << 8) | (below.lo >> 56), (own.hi << 8) | (below.hi >> 56)};
  } else {
    const Half lo = __builtin_shufflevector(below.hi, own.lo, 3, 4, 5, 6);
    const Half hi = __builtin_shufflevector(own.lo, own.hi, 3, 4, 5, 6);
    return {lo, hi};
  }
}

/// At every cell c the bit of c + e_axis; `above` is the block after `own` along the axis.
template <int axis>
inline Plane from_high(Plane own, Plane above) {
  using Half = Plane::Half;
  if constexpr (axis == 0) {
    constexpr std::uint64_t rest = 0x7f7f7f7f7f7f7f7fu, last = 0x8080808080808080u;
    return {((own.lo >> 1) & rest) | ((above.lo << 7) & last),
            ((own.hi >> 1) & rest) | ((above.hi << 7) & last)};
  } else if constexpr (axis == 1) {
    return {(own.lo >> 8) | (above.lo << 56), (own.hi >> 8) | (above.hi << 56)};
  } else {
    const Half lo = __builtin_shufflevector(own.lo, own.hi, 1, 2, 3, 4);
    const Half hi = __builtin_shufflevector(own.hi, above.lo, 1, 2, 3, 4);
    return {lo, hi};
  }
}

}  // namespace lacuna
