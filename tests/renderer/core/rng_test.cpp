#include "renderer/core/rng.h"

#include <gtest/gtest.h>

#include <cmath>
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
  constexpr std::uint64_t last_path = (1ULL << 56) - 1;
  for (const P p : {P::light_path, P::emission_ranges, P::test, P::visibility, P::gather,
                    P::particles, P::branch, P::bootstrap, P::chain, P::groups, P::emission_means,
                    P::eye_records, P::arriving_power, P::cache_points, P::passes}) {
    first.insert(Rng(1, 2, 3, p).next_u32());
    first.insert(Rng(1, 2, last_path, p).next_u32());
  }
  EXPECT_EQ(first.size(), 6U + 2 * 15);
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

TEST(Rng, DecidesWithTheProbabilityItIsGiven) {
  Rng rng(2, 0, 0, Rng::Purpose::test);
  const auto share = [&](float p, int n) {
    int decided = 0;
    for (int i = 0; i < n; ++i) decided += rng.decide(p) ? 1 : 0;
    return decided;
  };
  EXPECT_EQ(share(0, 1000), 0);
  EXPECT_EQ(share(1, 1000), 1000);
  EXPECT_NEAR(share(0.3F, 1'000'000), 3e5, 4.5 * std::sqrt(0.21e6));
  // 0.01 are expected; of numbers in steps of 2^-24, 6 would be below.
  EXPECT_LE(share(1e-10F, 100'000'000), 1);  // more: with probability 5e-5
}

TEST(Rng, ChoicesAreUniformAndFine) {
  Rng rng(3, 0, 0, Rng::Purpose::test);
  constexpr int n = 1 << 20;
  double sum = 0, product = 0, low_sum = 0;
  for (int i = 0; i < n; ++i) {
    const double u = rng.next_choice();
    const auto [choice, point] = rng.next_choice_and_point();
    ASSERT_TRUE(u >= 0 && u < 1 && choice >= 0 && choice < 1);
    ASSERT_TRUE(point.x >= 0 && point.x < 1 && point.y >= 0 && point.y < 1);
    sum += u + choice;
    // The bits below 2^-32 of a choice are none of the point's.
    const double low = std::ldexp(choice, 32) - std::floor(std::ldexp(choice, 32));
    product += (low - 0.5) * (double(point.x) - 0.5 + double(point.y) - 0.5);
    low_sum += low + std::ldexp(u, 32) - std::floor(std::ldexp(u, 32));
  }
  EXPECT_NEAR(sum / n, 1, 4.5 * std::sqrt(2.0 / 12 / n));
  EXPECT_NEAR(product / n, 0, 4.5 * std::sqrt(2.0 / 144 / n));
  EXPECT_NEAR(low_sum / n, 1, 0.01);  // they are there
}

}  // namespace
}  // namespace lacuna
