#pragma once

#include <array>
#include <cstdint>

namespace lacuna {

/// A sample of a low-discrepancy sequence of any number of dimensions, padded from pairs: each pair
/// is the first two dimensions of Sobol' with its own hashed shuffling and Owen scrambling (Burley
/// 2020, "Practical hash-based Owen scrambling"). In each pair, any aligned block of 2^m samples
/// has one point in each elementary interval of area 2^-m. Different pairs, and different keys, are
/// independent.
class SobolSample {
 public:
  /// `key`: uniform random bits that select the randomisation.
  SobolSample(std::array<std::uint32_t, 2> key, std::uint32_t index)
      : key_(key), reversed_(reverse(index)) {}
  SobolSample() = default;

  using Words = std::array<std::uint32_t, 16>;
  /// The coordinates of dimensions 16 `block` to 16 `block` + 15, as 32 bits each. `out` is aligned
  /// to 32 bytes.
  void words(std::uint32_t block, Words& out) const;

  static std::uint32_t reverse(std::uint32_t v) {
    v = (v >> 1 & 0x55555555) | (v & 0x55555555) << 1;
    v = (v >> 2 & 0x33333333) | (v & 0x33333333) << 2;
    v = (v >> 4 & 0x0f0f0f0f) | (v & 0x0f0f0f0f) << 4;
    return __builtin_bswap32(v);
  }

 private:
  std::array<std::uint32_t, 2> key_{};
  std::uint32_t reversed_ = 0;
};

}  // namespace lacuna
