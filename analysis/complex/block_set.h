#pragma once

#include <Imath/ImathVec.h>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna {

/// A set of blocks of a complex, as one bit a block: small enough to be walked whole for every
/// layer, and walked in any order of the axes.
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
  void clear() { words_.assign(words_.size(), 0); }
  bool empty() const {
    for (const std::uint64_t w : words_) {
      if (w != 0) return false;
    }
    return true;
  }
  Imath::V3i blocks() const { return blocks_; }

  /// Visits (bx, by, bz), ascending along every axis but `descending` (-1: all ascend). With x
  /// descending it is x that goes down within a row.
  template <class F>
  void for_each(int descending, const F& visit) const {
    for (int k = 0; k < blocks_.z; ++k) {
      const int bz = descending == 2 ? blocks_.z - 1 - k : k;
      for (int j = 0; j < blocks_.y; ++j) {
        const int by = descending == 1 ? blocks_.y - 1 - j : j;
        descending == 0 ? row_down(by, bz, visit) : row_up(by, bz, visit);
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
      for (std::uint64_t w = words_[word(i, by, bz)]; w != 0; w &= w - 1) {
        visit(i * 64 + std::countr_zero(w), by, bz);
      }
    }
  }
  template <class F>
  void row_down(int by, int bz, const F& visit) const {
    for (int i = row_words_ - 1; i >= 0; --i) {
      for (std::uint64_t w = words_[word(i, by, bz)]; w != 0;) {
        const int top = 63 - std::countl_zero(w);
        visit(i * 64 + top, by, bz);
        w ^= std::uint64_t{1} << top;
      }
    }
  }

  Imath::V3i blocks_;
  int row_words_;
  std::vector<std::uint64_t> words_;
};

}  // namespace lacuna
