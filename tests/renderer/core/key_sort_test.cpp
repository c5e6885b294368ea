#include "renderer/core/key_sort.h"

#include <gtest/gtest.h>

#include <numeric>

#include "renderer/core/rng.h"

namespace lacuna {
namespace {

/// The items 0, 1, ... with keys below `keys`, sorted in blocks of 100 on `threads` threads.
std::vector<std::uint32_t> sorted(std::span<const std::uint32_t> key_of, std::size_t keys,
                                  int threads, KeySort<std::uint32_t>& sort) {
  constexpr std::size_t block = 100;
  std::vector<std::uint32_t> order(key_of.size());
  sort.sort((key_of.size() + block - 1) / block, keys,
            [&](std::size_t b, const auto& use) {
              for (std::size_t i = b * block; i < std::min(key_of.size(), (b + 1) * block); ++i) {
                use(key_of[i], static_cast<std::uint32_t>(i));
              }
            },
            [&](std::size_t k, std::uint32_t i) { order[k] = i; }, ThreadPool(threads));
  return order;
}

TEST(KeySort, IsAStableSortForAnyThreads) {
  Rng rng(1, 0, 0, Rng::Purpose::test);
  KeySort<std::uint32_t> sort;  // keeps its memory
  for (const std::size_t keys : {1, 7, 255, 256, 257, 100000}) {
    for (const std::size_t n : {0, 1, 99, 100, 12345}) {
      std::vector<std::uint32_t> key_of(n);
      for (auto& k : key_of) k = static_cast<std::uint32_t>(rng.below(keys));
      std::vector<std::uint32_t> expected(n);
      std::iota(expected.begin(), expected.end(), 0U);
      std::ranges::stable_sort(expected, {}, [&](std::uint32_t i) { return key_of[i]; });
      for (const int threads : {1, 3}) {
        ASSERT_EQ(sorted(key_of, keys, threads, sort), expected) << keys << " keys, " << n;
        ASSERT_EQ(sort.size(), n);
        ASSERT_EQ(sort.starts().size(), keys + 1);
        for (std::size_t k = 0; k < keys; ++k) {
          for (std::uint32_t at = sort.starts()[k]; at < sort.starts()[k + 1]; ++at) {
            ASSERT_EQ(key_of[expected[at]], k);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace lacuna
