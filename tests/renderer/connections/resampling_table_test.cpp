#include "renderer/connections/resampling_table.h"

#include <gtest/gtest.h>

#include "tests/statistics.h"

namespace lacuna {
namespace {

using Weights = std::vector<std::vector<double>>;

ResamplingTable table_of(const Weights& weights, Combination combination) {
  std::vector<std::span<const double>> spans(weights.begin(), weights.end());
  return {spans, combination};
}

double total(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum;
}

/// Noel 2015, 11.3, as it is said there. Mixture: one of the distributions, all alike, then a draw
/// from it. Max: a draw counts only where no other distribution gives it more; probabilities times
/// these weights, renormalised.
std::vector<double> defined(const Weights& weights, Combination combination) {
  Weights p;
  for (const auto& w : weights) {
    const double sum = total(w);
    if (!(sum > 0)) continue;
    p.push_back(w);
    for (double& x : p.back()) x /= sum;
  }
  const std::size_t n = weights[0].size();
  if (combination == Combination::max) {
    for (std::size_t i = 0; i < n; ++i) {
      std::size_t best = 0;
      for (std::size_t k = 1; k < p.size(); ++k) best = p[k][i] > p[best][i] ? k : best;
      for (std::size_t k = 0; k < p.size(); ++k) {
        if (k != best) p[k][i] = 0;
      }
    }
    std::erase_if(p, [](const auto& w) { return total(w) == 0; });
    for (auto& w : p) {
      const double sum = total(w);
      for (double& x : w) x /= sum;
    }
  }
  std::vector<double> pmf(n);
  for (const auto& w : p) {
    for (std::size_t i = 0; i < n; ++i) pmf[i] += w[i] / static_cast<double>(p.size());
  }
  return pmf;
}

/// `count` distributions over `n` things, of very different weights, some of them 0.
Weights random_weights(Rng& rng, std::size_t count, std::size_t n) {
  Weights all(count, std::vector<double>(n));
  for (auto& w : all) {
    const double scale = std::exp(40 * double(rng.next()) - 20);
    for (double& x : w) x = rng.next() < 0.3F ? 0 : scale * std::exp(8 * double(rng.next()));
  }
  all.back().assign(n, 1.0);
  return all;
}

constexpr std::array both_combinations{Combination::max, Combination::mixture};

TEST(ResamplingTable, IsWhatItsDefinitionSays) {
  Rng rng(81, 0, 0, Rng::Purpose::test);
  for (int trial = 0; trial < 200; ++trial) {
    const Weights w = random_weights(rng, 1 + rng.next_u32() % 4, 1 + rng.next_u32() % 50);
    for (const Combination combination : both_combinations) {
      const ResamplingTable table = table_of(w, combination);
      const std::vector<double> expected = defined(w, combination);
      ASSERT_FALSE(table.empty());
      double sum = 0;
      for (std::uint32_t i = 0; i < expected.size(); ++i) {
        const double p = double(table.pmf(i).value);
        EXPECT_NEAR(p, expected[i], 1e-6 * expected[i]);
        EXPECT_GT(p, 0) << "what the uniform distribution takes can be drawn";
        sum += p;
      }
      EXPECT_NEAR(sum, 1, 1e-5);
    }
  }
}

TEST(ResamplingTable, DrawsWithTheProbabilitiesItReports) {
  Rng rng(82, 0, 0, Rng::Purpose::test);
  constexpr int tables = 6, draws = 100000;
  const double level = statistics::sidak(1e-6, 2 * tables);
  for (int trial = 0; trial < tables; ++trial) {
    const Weights w = random_weights(rng, 3, 40);
    for (const Combination combination : both_combinations) {
      const ResamplingTable table = table_of(w, combination);
      std::vector<double> observed(40), expected(40);
      for (std::uint32_t i = 0; i < 40; ++i) expected[i] = draws * double(table.pmf(i).value);
      for (int i = 0; i < draws; ++i) {
        const AliasTable::Sample d = table.resolve(table.choose(rng), rng);
        ASSERT_EQ(d.pmf.value, table.pmf(d.index).value);
        ++observed[d.index];
      }
      const auto result = statistics::chi_square_test(observed, expected);
      EXPECT_GT(result.p, level) << result.message;
    }
  }
}

TEST(ResamplingTable, OwnerIsTheDistributionThatGivesMost) {
  const Weights w{{8, 1, 0, 1}, {0, 0, 1, 0}, {1, 1, 1, 1}};  // 0.8, 0.1, 0, 0.1; 1; 0.25 each
  for (const Combination combination : both_combinations) {
    const ResamplingTable table = table_of(w, combination);
    EXPECT_EQ(table.distribution(0), 0);
    EXPECT_EQ(table.distribution(1), 2);
    EXPECT_EQ(table.distribution(2), 1);
    EXPECT_EQ(table.distribution(3), 2);
  }
}

TEST(ResamplingTable, ADistributionOfZerosTakesNoPart) {
  Rng rng(83, 0, 0, Rng::Purpose::test);
  const std::vector<double> zeros(30, 0.0);
  for (int trial = 0; trial < 20; ++trial) {
    const Weights w = random_weights(rng, 3, 30);
    for (const Combination combination : both_combinations) {
      const ResamplingTable without = table_of(w, combination);
      const ResamplingTable with = table_of({zeros, w[0], zeros, w[1], w[2], zeros}, combination);
      for (std::uint32_t i = 0; i < 30; ++i) {
        EXPECT_EQ(with.pmf(i).value, without.pmf(i).value);
        EXPECT_NE(with.distribution(i), 0);
        EXPECT_NE(with.distribution(i), 2);
        EXPECT_NE(with.distribution(i), 5);
      }
    }
  }
}

TEST(ResamplingTable, ThingsThatNoDistributionGivesAreNeverDrawn) {
  const Weights w{{1, 0, 0, 5}, {0, 0, 2, 1}};
  Rng rng(84, 0, 0, Rng::Purpose::test);
  for (const Combination combination : both_combinations) {
    const ResamplingTable table = table_of(w, combination);
    EXPECT_EQ(table.pmf(1).value, 0);
    for (int i = 0; i < 10000; ++i) EXPECT_NE(table.resolve(table.choose(rng), rng).index, 1U);
  }
}

TEST(ResamplingTable, IsEmptyWhereNothingCanBeDrawn) {
  EXPECT_TRUE(ResamplingTable().empty());
  for (const Combination combination : both_combinations) {
    EXPECT_TRUE(table_of({{}, {}}, combination).empty());
    EXPECT_TRUE(table_of({{0, 0}, {0, 0}}, combination).empty());
    const ResamplingTable one = table_of({{0}, {3}}, combination);
    EXPECT_EQ(one.pmf(0).value, 1);
    EXPECT_EQ(one.distribution(0), 1);
  }
}

}  // namespace
}  // namespace lacuna
