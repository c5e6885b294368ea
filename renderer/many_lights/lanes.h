#pragma once

#include <array>
#include <cstdint>

#include "analysis/geometry/bits.h"
#include "analysis/geometry/simd.h"

namespace lacuna {

/// One float for each of 64 lights.
struct alignas(32) Lanes {
  static constexpr int size = 64;
  std::array<float, size> v{};

  float& operator[](int i) { return v[static_cast<std::size_t>(i)]; }
  float operator[](int i) const { return v[static_cast<std::size_t>(i)]; }

  static constexpr int groups = size / 8;
  Float8 eight(int group) const {
    return Float8::load(v.data() + static_cast<std::ptrdiff_t>(8 * group));
  }
  void set(int group, Float8 values) {
    values.store(v.data() + static_cast<std::ptrdiff_t>(8 * group));
  }
};

/// A mask: bit i is set if value i is above 0.
inline std::uint64_t positive(const Lanes& a) {
  std::uint64_t bits = 0;
  for (int k = 0; k < Lanes::groups; ++k)
    bits |= std::uint64_t{movemask(a.eight(k) > 0)} << (8 * k);
  return bits;
}

/// The sum of all values, in a fixed order.
inline float sum(const Lanes& a) {
  Float8 s = a.eight(0);
  for (int k = 1; k < Lanes::groups; ++k) s = s + a.eight(k);
  return reduce_add(s);
}

/// The sum of all products, in a fixed order.
inline float sum_of_products(const Lanes& a, const Lanes& b) {
  Float8 s = a.eight(0) * b.eight(0);
  for (int k = 1; k < Lanes::groups; ++k) s = s + a.eight(k) * b.eight(k);
  return reduce_add(s);
}

}  // namespace lacuna
