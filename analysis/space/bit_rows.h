#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "analysis/geometry/bit_grid.h"

namespace lacuna {

/// The bits of one line of cells along x, 64 to a word, x = 0 lowest; bits beyond the size are
/// 0.
class BitRow {
 public:
  explicit BitRow(int width)
      : width_(width), words_((static_cast<std::size_t>(width) + 63) / 64, 0) {}

  /// A line of a grid of the same width.
  void read(const BitGrid3& grid, int y, int z) {
    clear();
    const int blocks = grid.blocks().x, shift = 8 * (y & 7);
    if (blocks == 0) return;
    const BitBlock* block = &grid.block(0, y >> 3, z >> 3);
    for (int bx = 0; bx < blocks; ++bx) {
      const std::uint64_t byte = block[bx].z[static_cast<std::size_t>(z & 7)] >> shift & 0xff;
      words_[static_cast<std::size_t>(bx) >> 3] |= byte << (8 * (bx & 7));
    }
  }

  /// Calls run(x0, x1) for every longest run [x0, x1) of 1 bits, ascending.
  template <class Run>
  void for_each_run(Run&& run) const {
    for (int x = next(0, true); x < width_;) {
      const int end = next(x, false);
      run(x, end);
      x = next(end, true);
    }
  }

  /// Sets the 1 bits of `byte` at x .. x + 7, which may reach beyond either end.
  void add_byte(std::uint64_t byte, int x) {
    if (x < 0) {
      byte >>= -x;
      x = 0;
    }
    const auto word = static_cast<std::size_t>(x) >> 6;
    if (word < words_.size()) words_[word] |= byte << (x & 63);
    if ((x & 63) > 56 && word + 1 < words_.size()) words_[word + 1] |= byte >> (64 - (x & 63));
  }
  void clear() { std::fill(words_.begin(), words_.end(), 0); }
  void complement() {
    for (std::uint64_t& w : words_) w = ~w;
    if (width_ % 64 != 0) words_.back() &= (std::uint64_t{1} << width_ % 64) - 1;
  }

  /// Moves every bit to the next position.
  void shift_up() {
    std::uint64_t carry = 0;
    for (std::uint64_t& w : words_) carry = std::exchange(w, w << 1 | carry) >> 63;
  }

  /// The first position from `x` on whose bit is `value`, or the width.
  int next(int x, bool value) const {
    while (x < width_) {
      const std::uint64_t word = words_[static_cast<std::size_t>(x) >> 6];
      const std::uint64_t rest = (value ? word : ~word) >> (x & 63);
      if (rest != 0) return std::min(width_, x + std::countr_zero(rest));
      x = (x | 63) + 1;
    }
    return width_;
  }

 private:
  int width_;
  std::vector<std::uint64_t> words_;
};

/// Sets the bits [x0, x1) of a line along x to 0.
inline void reset_run(BitGrid3& grid, int x0, int x1, int y, int z) {
  for (int bx = x0 >> 3; bx <= (x1 - 1) >> 3; ++bx) {
    const int low = std::max(x0 - 8 * bx, 0), high = std::min(x1 - 8 * bx, 8);
    const std::uint64_t bits = (std::uint64_t{1} << high) - (std::uint64_t{1} << low);
    grid.block(bx, y >> 3, z >> 3).z[static_cast<std::size_t>(z & 7)] &= ~(bits << (8 * (y & 7)));
  }
}

}  // namespace lacuna
