#include "renderer/core/sobol.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "renderer/core/rng.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

Rng sample(std::uint64_t index, std::uint64_t pixel = 0, std::uint32_t randomisation = 0,
           std::uint64_t seed = 1) {
  return Rng::of_sequence(seed, pixel, randomisation, index, Rng::Purpose::test);
}

/// The two words of pair `pair` of the dimensions of `rng`.
std::array<std::uint32_t, 2> pair_of(Rng rng, int pair) {
  for (int i = 0; i < 2 * pair; ++i) rng.next_u32();
  const std::uint32_t x = rng.next_u32();
  return {x, rng.next_u32()};
}

/// A word's first `bits`.
std::uint32_t first(std::uint32_t word, int bits) { return bits == 0 ? 0 : word >> (32 - bits); }

// The property that defines a (0, 2)-sequence: one point in each elementary interval.
TEST(Sobol, EachPairOfAnAlignedRunIsANet) {
  for (const int pair : {0, 1, 7, 8, 40}) {
    for (const int m : {1, 4, 8}) {
      for (const std::uint64_t run : {0, 5, 1000}) {
        for (int bits_x = 0; bits_x <= m; ++bits_x) {
          std::set<std::uint64_t> intervals;
          for (std::uint64_t i = 0; i < 1U << m; ++i) {
            const auto [x, y] = pair_of(sample((run << m) + i, 3), pair);
            intervals.insert(std::uint64_t{first(x, bits_x)} << 32 | first(y, m - bits_x));
          }
          ASSERT_EQ(intervals.size(), 1U << m) << pair << ", run " << run << ", 2^" << m;
        }
      }
    }
  }
}

/// p of n words in pairs, as to being uniform in the square.
template <class Pair>
double uniform_p(int n, Pair&& pair) {
  constexpr int side = 16;
  std::vector<double> count(side * side, 0.0);
  for (int i = 0; i < n; ++i) {
    const auto [x, y] = pair(i);
    ++count[first(x, 4) * side + first(y, 4)];
  }
  return statistics::chi_square_test(
             count, std::vector<double>(count.size(), double(n) / double(count.size())))
      .p;
}

// One sample over many randomisations: uniform, so that estimates are unbiased.
TEST(Sobol, EachSampleIsUniform) {
  constexpr int n = 1 << 15;
  for (const std::uint64_t index : {0, 1, 77}) {
    EXPECT_GT(uniform_p(n, [&](int i) { return pair_of(sample(index, std::uint64_t(i)), 2); }),
              1e-5);
    EXPECT_GT(
        uniform_p(n, [&](int i) { return pair_of(sample(index, 0, 0, std::uint64_t(i)), 2); }),
        1e-5);
  }
}

// What a path uses together: numbers of different pairs, samples of different pixels, of different
// randomisations, and the two dimensions of the last bits.
TEST(Sobol, PairsAndRandomisationsAreIndependent) {
  constexpr int n = 1 << 15;
  const auto together = [&](auto&& a, auto&& b) {
    return uniform_p(n, [&](int i) {
      return std::array{a(std::uint64_t(i)), b(std::uint64_t(i))};
    });
  };
  const auto word = [](int pair, int which, std::uint64_t pixel = 0, std::uint32_t half = 0) {
    return
        [=](std::uint64_t i) { return pair_of(sample(i, pixel, half), pair)[std::size_t(which)]; };
  };
  const auto base = word(0, 0);
  EXPECT_GT(together(base, word(1, 0)), 1e-5);
  EXPECT_GT(together(base, word(1, 1)), 1e-5);
  EXPECT_GT(together(base, word(8, 0)), 1e-5);
  EXPECT_GT(together(base, word(0, 0, 1)), 1e-5);
  EXPECT_GT(together(base, word(0, 0, 0, 1)), 1e-5);
  const auto low = [&](std::uint64_t i) { return word(0, 0)(i) << 20; };
  EXPECT_GT(together(base, low), 1e-5);
}

// Sequences go on behind 2^32 samples with another randomisation.
TEST(Sobol, LongSequences) {
  EXPECT_NE(sample(5).next_u32(), sample(5 + (std::uint64_t{1} << 32)).next_u32());
}

TEST(Sobol, TwoNumbersAreAPairAndVerticesBeginAtMultiplesOfEight) {
  Rng rng = sample(9);
  rng.next_u32();
  const V2f aligned = rng.next2();
  EXPECT_EQ(aligned.x, float(pair_of(sample(9), 1)[0] >> 8) * 0x1p-24F);
  EXPECT_EQ(aligned.y, float(pair_of(sample(9), 1)[1] >> 8) * 0x1p-24F);
  rng.next_vertex();
  EXPECT_EQ(rng.next_u32(), pair_of(sample(9), 4)[0]);
  rng.next_vertex();
  EXPECT_EQ(rng.next_u32(), pair_of(sample(9), 8)[0]);
}

}  // namespace
}  // namespace lacuna
