#include "renderer/core/rng.h"

#include <gtest/gtest.h>

#include <set>

namespace lacuna {
namespace {

// The known answers of the generator's authors (kat_vectors of Random123).
TEST(Philox, KnownAnswers) {
  EXPECT_EQ(Rng::philox({0, 0, 0, 0}, {0, 0}),
            (Rng::Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const auto f = 0xffffffffU;
  EXPECT_EQ(Rng::philox({f, f, f, f}, {f, f}),
            (Rng::Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(Rng::philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Rng::Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Rng, NumbersAreTheBlocksInOrder) {
  const std::uint64_t seed = 0x0123456789abcdef;
  Rng rng(seed, 77, 0xabcdef0123, Rng::Purpose::light_path);
  for (std::uint32_t block = 0; block < 9; ++block) {
    const Rng::Block expected =
        Rng::philox({block, 0xcdef0123, 0xab | 1U << 24, 77}, {0x89abcdef, 0x01234567});
    for (const std::uint32_t word : expected) ASSERT_EQ(rng.next_u32(), word) << "block " << block;
  }
}

TEST(Rng, StreamsDifferInEveryPartOfTheirKey) {
  using P = Rng::Purpose;
  std::set<std::uint32_t> first;
  first.insert(Rng(1, 2, 3).next_u32());
  first.insert(Rng(2, 2, 3).next_u32());
  first.insert(Rng(1ULL << 32 | 1, 2, 3).next_u32());
  first.insert(Rng(1, 3, 3).next_u32());
  first.insert(Rng(1, 2, 4).next_u32());
  first.insert(Rng(1, 2, 3 | 1ULL << 32).next_u32());
  first.insert(Rng(1, 2, 3, P::light_path).next_u32());
  EXPECT_EQ(first.size(), 7U);
}

TEST(Rng, SameKeySameNumbers) {
  Rng a(7, 8, 9);
  Rng b(7, 8, 9);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next_u32(), b.next_u32());
}

TEST(Rng, NextIsBelowOneAndUniform) {
  Rng rng(1, 0, 0, Rng::Purpose::test);
  constexpr int n = 1 << 20;
  constexpr int cells = 256;
  std::array<int, cells> count{};
  for (int i = 0; i < n; ++i) {
    const float u = rng.next();
    ASSERT_GE(u, 0.0F);
    ASSERT_LT(u, 1.0F);
    ++count[static_cast<std::size_t>(u * cells)];
  }
  const double expected = double(n) / cells;
  double chi2 = 0;
  for (const int c : count) chi2 += (c - expected) * (c - expected) / expected;
  // 255 degrees of freedom: mean 255, standard deviation 22.6.
  EXPECT_LT(chi2, 255 + 5 * 22.6);
  EXPECT_GT(chi2, 255 - 5 * 22.6);
}

}  // namespace
}  // namespace lacuna
