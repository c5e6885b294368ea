#pragma once

#include <Imath/ImathVec.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/geometry/bits.h"

namespace lacuna {

/// A set of blocks of a complex, as one bit a block, walked by slices across y or z. Several
/// threads may work at it, each at slices of its own.
class BlockSet {
 public:
  explicit BlockSet(Imath::V3i blocks)
      : blocks_(blocks),
        row_words_((blocks.x + 63) / 64),
        words_(static_cast<std::size_t>(row_words_) * static_cast<std::size_t>(blocks.y) *
               static_cast<std::size_t>(blocks.z)) {}

  void insert(int bx, int by, int bz) {
    words_[word(bx >> 6, by, bz)] |= std::uint64_t{1} << (bx & 63);
  }
  /// The blocks from `first` to `last`, both included, along x.
  void insert_row(int first, int last, int by, int bz) {
    for (int i = first >> 6; i <= last >> 6; ++i) {
      const int low = std::max(first - 64 * i, 0), high = std::min(last - 64 * i, 63);
      words_[word(i, by, bz)] |= (~std::uint64_t{0} << low) & (~std::uint64_t{0} >> (63 - high));
    }
  }
  bool contains(int bx, int by, int bz) const {
    return (words_[word(bx >> 6, by, bz)] >> (bx & 63) & 1) != 0;
  }
  Imath::V3i blocks() const { return blocks_; }

  /// Visits the blocks (bx, by, bz) of the slice where `across` (1 y, 2 z) is `at`, ascending along
  /// both its axes but `descending` (-1: both ascend).
  template <class F>
  void for_each(int across, int at, int descending, const F& visit) const {
    const int along = 3 - across, n = blocks_[along];
    for (int i = 0; i < n; ++i) {
      const int j = descending == along ? n - 1 - i : i;
      const int by = across == 1 ? at : j, bz = across == 1 ? j : at;
      descending == 0 ? row_down(by, bz, visit) : row_up(by, bz, visit);
    }
  }
  void clear(int across, int at) {
    const int n = blocks_[3 - across];
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < row_words_; ++i) {
        words_[across == 1 ? word(i, at, j) : word(i, j, at)] = 0;
      }
    }
  }

 private:
  std::size_t word(int i, int by, int bz) const {
    return (static_cast<std::size_t>(bz) * static_cast<std::size_t>(blocks_.y) +
            static_cast<std::size_t>(by)) *
               static_cast<std::size_t>(row_words_) +
           static_cast<std::size_t>(i);
  }
  template <class F>
  void row_up(int by, int bz, const F& visit) const {
    for (int i = 0; i < row_words_; ++i) {
      for_each_bit(words_[word(i, by, bz)], [&](int bit) { visit(i * 64 + bit, by, bz); });
    }
  }
  template <class F>
  void row_down(int by, int bz, const F& visit) const {
    for (int i = row_words_ - 1; i >= 0; --i) {
      for_each_bit_descending(words_[word(i, by, bz)],
                              [&](int bit) { visit(i * 64 + bit, by, bz); });
    }
  }

  Imath::V3i blocks_;
  int row_words_;
  std::vector<std::uint64_t> words_;
};

}  // namespace lacuna
