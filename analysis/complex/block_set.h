#pragma once

#include <Imath/ImathVec.h>

#include <atomic>
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

  /// Safe from several threads.
  void insert(int bx, int by, int bz) {
    std::atomic_ref(words_[word(bx >> 6, by, bz)])
        .fetch_or(std::uint64_t{1} << (bx & 63), std::memory_order_relaxed);
  }
  void clear() { words_.assign(words_.size(), 0); }
  bool empty() const {
    for (const std::uint64_t w : words_) {
      if (w != 0) return false;
    }
    return true;
  }
  Imath::V3i blocks() const { return blocks_; }

  /// Number of blocks in each slice across an axis, y or z.
  std::vector<std::size_t> slices(int axis) const {
    std::vector<std::size_t> counts(static_cast<std::size_t>(axis == 1 ? blocks_.y : blocks_.z));
    for (int bz = 0; bz < blocks_.z; ++bz) {
      for (int by = 0; by < blocks_.y; ++by) {
        std::size_t n = 0;
        for (int i = 0; i < row_words_; ++i) {
          n += static_cast<std::size_t>(std::popcount(words_[word(i, by, bz)]));
        }
        counts[static_cast<std::size_t>(axis == 1 ? by : bz)] += n;
      }
    }
    return counts;
  }

  /// Blocks from `low` up to and without `high`.
  struct Range {
    Imath::V3i low, high;
  };
  Range all() const { return {Imath::V3i(0), blocks_}; }
  /// Visits the blocks (bx, by, bz) of a range along y and z (along x always all), ascending along
  /// every axis but `descending` (-1: all ascend).
  template <class F>
  void for_each(const Range& range, int descending, const F& visit) const {
    for (int k = range.low.z; k < range.high.z; ++k) {
      const int bz = descending == 2 ? range.low.z + range.high.z - 1 - k : k;
      for (int j = range.low.y; j < range.high.y; ++j) {
        const int by = descending == 1 ? range.low.y + range.high.y - 1 - j : j;
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
