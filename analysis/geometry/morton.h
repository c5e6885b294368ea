#pragma once

#include <cstdint>

namespace lacuna {

/// Bit i of `v` becomes bit 3 i, for the lowest 21 bits.
constexpr std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

/// The Morton code of a cell of a cube of 2^21 cells along each side: cells with similar codes are
/// close to one another, and the three highest bits of a code of 3 n bits are an octant of the cube
/// (Morton 1966). Coordinates in [0, 2^21).
constexpr std::uint64_t morton_code(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

}  // namespace lacuna
