#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel/thread_pool.h"
#include "renderer/core/huge_pages.h"

namespace lacuna {

/// Sorts items by an integer key, in parallel: a counting sort by ranges of keys, and within each
/// range by key. Items of one key keep their order, so that the result does not depend on the
/// number of threads. Keeps its memory for the next sort.
template <class Item>
class KeySort {
 public:
  /// Sorts the items of `blocks` blocks, fewer than 2^32, by keys below `keys`. `each_of(b, use)`
  /// calls `use(key, item)` for the items of block b in order, the same whenever it is called;
  /// `place(k, item)` is called for the item that has place k in the sorted order. Several threads
  /// call both.
  template <class EachOf, class Place>
  void sort(std::size_t blocks, std::size_t keys, const EachOf& each_of, const Place& place,
            const ThreadPool& pool) {
    const std::size_t of_range = std::max<std::size_t>(1, (keys + ranges - 1) / ranges);
    std::vector<std::array<std::uint32_t, ranges>> places(blocks);
    pool.for_each(static_cast<int>(blocks), [&](int b) {
      auto& count = places[static_cast<std::size_t>(b)];
      count.fill(0);
      each_of(static_cast<std::size_t>(b),
              [&](std::size_t key, const Item&) { ++count[key / of_range]; });
    });
    std::array<std::uint32_t, ranges + 1> range_starts{};
    std::uint32_t sum = 0;
    for (std::size_t r = 0; r < ranges; ++r) {
      range_starts[r] = sum;
      for (auto& count : places) sum += std::exchange(count[r], sum);
    }
    range_starts[ranges] = sum;
    entries_.resize(sum);
    pool.for_each(static_cast<int>(blocks), [&](int b) {
      auto& next = places[static_cast<std::size_t>(b)];
      each_of(static_cast<std::size_t>(b), [&](std::size_t key, const Item& item) {
        entries_.set(next[key / of_range]++, {static_cast<std::uint32_t>(key), item});
      });
    });
    starts_.resize(keys + 1);
    starts_.set(keys, sum);
    const std::size_t used = (keys + of_range - 1) / of_range;
    pool.for_each(static_cast<int>(used), [&](int r) {
      const std::size_t first = static_cast<std::size_t>(r) * of_range;
      const std::size_t n = std::min(of_range, keys - first);
      const std::uint32_t begin = range_starts[std::size_t(r)],
                          end = range_starts[std::size_t(r) + 1];
      std::vector<std::uint32_t> next(n, 0);
      for (std::uint32_t i = begin; i < end; ++i) ++next[entries_[i].key - first];
      std::uint32_t at = begin;
      for (std::size_t k = 0; k < n; ++k) {
        starts_.set(first + k, at);
        at += std::exchange(next[k], at);
      }
      for (std::uint32_t i = begin; i < end; ++i) {
        place(std::size_t{next[entries_[i].key - first]++}, entries_[i].item);
      }
    });
  }

  /// Of each key the place of its first item, and the end.
  std::span<const std::uint32_t> starts() const { return {starts_.begin(), starts_.end()}; }
  std::size_t size() const { return entries_.size(); }

 private:
  static constexpr std::size_t ranges = 256;

  struct Entry {
    std::uint32_t key;
    Item item;
  };
  HugeArray<Entry> entries_;
  HugeArray<std::uint32_t> starts_;
};

}  // namespace lacuna
