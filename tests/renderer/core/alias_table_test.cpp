#include "renderer/core/alias_table.h"

#include <gtest/gtest.h>

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
