#include "renderer/core/alias_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

namespace lacuna {
namespace {

double chi_square(const std::vector<double>& weights, int draws) {
  const AliasTable table(weights);
  std::vector<int> count(weights.size());
  Rng rng(3, 0, 0, Rng::Purpose::test);
  for (int i = 0; i < draws; ++i) ++count[table.sample(rng)];
  double sum = 0;
  for (const double w : weights) sum += w;
  double chi2 = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double expected = draws * weights[i] / sum;
    if (expected == 0) {
      EXPECT_EQ(count[i], 0) << "index " << i << " has no weight";
      continue;
    }
    EXPECT_NEAR(table.pmf(static_cast<std::uint32_t>(i)).value, weights[i] / sum, 1e-7);
    chi2 += (count[i] - expected) * (count[i] - expected) / expected;
  }
  return chi2;
}

TEST(AliasTable, DrawsInProportion) {
  // 4 degrees of freedom (one weight is 0): the 99.99 % quantile is 23.5.
  EXPECT_LT(chi_square({1, 2, 0, 3, 10, 4}, 200000), 23.5);
  EXPECT_LT(chi_square({1e-30, 2e-30, 0, 3e-30, 1e-29, 4e-30}, 200000), 23.5);
  EXPECT_LT(chi_square({1e300, 2e300, 0, 3e300, 1e301, 4e300}, 200000), 23.5);
}

// By one number: indices in proportion, what is left of it uniform, pmf() as stated.
TEST(AliasTable, OneNumberDrawsAndIsLeft) {
  const std::vector<double> weights{1, 2, 0, 3, 10, 4};
  const AliasTable table(weights);
  Rng rng(4, 0, 0, Rng::Purpose::test);
  constexpr int draws = 200000, parts = 4;
  std::vector<int> count(weights.size() * parts);
  for (int i = 0; i < draws; ++i) {
    double u = rng.next_choice();
    const AliasTable::Sample d = table.sample(u);
    ASSERT_EQ(d.pmf.value, table.pmf(d.index).value);
    ASSERT_GE(u, 0);
    ASSERT_LE(u, 1);
    ++count[d.index * parts + std::min(static_cast<std::size_t>(u * parts), std::size_t{3})];
  }
  double chi2 = 0;
  for (std::size_t k = 0; k < count.size(); ++k) {
    const double expected = draws * weights[k / parts] / 20 / parts;
    if (expected == 0) {
      EXPECT_EQ(count[k], 0);
      continue;
    }
    chi2 += (count[k] - expected) * (count[k] - expected) / expected;
  }
  EXPECT_LT(chi2, 49.6);  // 19 degrees of freedom: the 99.99 % quantile
}

TEST(AliasTable, TellsAMillionBinsApart) {
  // Half the bins weigh three times as much as the others; with coarse random numbers they would
  // not.
  constexpr std::size_t n = 1 << 20;
  std::vector<double> weights(n);
  for (std::size_t i = 0; i < n; ++i) weights[i] = i % 2 == 0 ? 1 : 3;
  const AliasTable table(weights);
  Rng rng(5, 0, 0, Rng::Purpose::test);
  constexpr int draws = 1 << 20;
  int odd = 0;
  for (int i = 0; i < draws; ++i) odd += static_cast<int>(table.sample(rng) % 2);
  const double sigma = std::sqrt(draws * 0.75 * 0.25);
  EXPECT_NEAR(odd, draws * 0.75, 4 * sigma);
}

/// The first of the 32-bit numbers for which `is` holds; it holds for all after that.
template <class Is>
double first_of_32_bits(Is&& is) {
  std::uint64_t low = 0, high = std::uint64_t{1} << 32;
  while (low < high) {
    const std::uint64_t middle = (low + high) / 2;
    if (is(static_cast<std::uint32_t>(middle))) {
      high = middle;
    } else {
      low = middle + 1;
    }
  }
  return double(low);
}

/// How probable each index is, from all 2^64 pairs of numbers that a draw may consist of.
std::vector<double> drawn_probabilities(const AliasTable& table) {
  std::vector<double> drawn(table.size());
  double begin = 0;
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    const double end = first_of_32_bits([&](std::uint32_t u) { return table.choose(u) > i; });
    const std::uint32_t last = table.resolve(i, ~0U).index;
    const double kept =
        first_of_32_bits([&](std::uint32_t u) { return table.resolve(i, u).index == last; });
    if (kept > 0) drawn[table.resolve(i, 0).index] += (end - begin) * kept * 0x1p-64;
    drawn[last] += (end - begin) * (0x1p32 - kept) * 0x1p-64;
    begin = end;
  }
  return drawn;
}

TEST(AliasTable, DrawsWhatItStatesOverManyDecades) {
  Rng rng(7, 0, 0, Rng::Purpose::test);
  for (const std::size_t n : {2U, 3U, 25U, 1000U, 40000U}) {
    std::vector<double> weights(n);
    for (std::size_t i = 0; i < n; ++i) {
      weights[i] = std::pow(10.0, i < 25 ? -double(i) : -24 * double(rng.next()));
    }
    const AliasTable table(weights);
    double sum = 0;
    for (const double w : weights) sum += w;
    const std::vector<double> drawn = drawn_probabilities(table);
    for (std::uint32_t i = 0; i < n; ++i) {
      const double stated = table.pmf(i).value;
      ASSERT_GT(drawn[i], 0) << "index " << i << " of " << n;
      ASSERT_NEAR(stated / drawn[i], 1, 0x1p-24) << "index " << i << " of " << n;
      // Bins and thresholds are a whole number of 2^-32 each.
      const double p = weights[i] / sum;
      ASSERT_NEAR(drawn[i], p, p * double(n) * 0x1p-32 + 2 * 0x1p-32) << "index " << i;
    }
  }
}

TEST(AliasTable, DrawsRareEntriesRarely) {
  // Fifteen of 1e-10 each: 0.15 of them are expected; drawn in steps of 2^-24 there were 5.6.
  std::vector<double> weights(16, 1e-10);
  weights[0] = 1;
  const AliasTable table(weights);
  Rng rng(11, 0, 0, Rng::Purpose::test);
  int rare = 0;
  for (int i = 0; i < 100'000'000; ++i) rare += table.sample(rng) != 0 ? 1 : 0;
  EXPECT_LE(rare, 3);  // more: with probability 2e-5
}

TEST(AliasTable, NothingToDraw) {
  EXPECT_TRUE(AliasTable().empty());
  EXPECT_TRUE(AliasTable(std::vector<double>{0, 0}).empty());
}

TEST(AliasTable, RefusesWhatIsNoWeight) {
  EXPECT_THROW(AliasTable(std::vector<double>{1, -1}), std::invalid_argument);
  EXPECT_THROW(AliasTable(std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
  EXPECT_THROW(AliasTable(std::vector<double>{1, std::numeric_limits<double>::infinity()}),
               std::invalid_argument);
}

}  // namespace
}  // namespace lacuna
