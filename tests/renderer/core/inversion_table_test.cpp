#include "renderer/core/inversion_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "renderer/core/rng.h"

namespace lacuna {
namespace {

// Every interval is met once, in order, and holds what is stated.
TEST(InversionTable, IntervalsTileAllNumbersInOrder) {
  Rng rng(7, 0, 0, Rng::Purpose::test);
  for (const std::size_t n : {1U, 2U, 3U, 25U, 1000U, 40000U}) {
    std::vector<double> weights(n);
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const bool none = n > 2 && i % 5 != 1;
      weights[i] = none && i % 2 == 0 ? 0 : std::pow(10.0, -24 * double(rng.next()));
      sum += weights[i];
    }
    const InversionTable table(weights);
    std::uint64_t next = 0;
    for (std::uint32_t i = 0; i < n; ++i) {
      if (weights[i] == 0) {
        EXPECT_EQ(table.pmf(i).value, 0);
        continue;
      }
      ASSERT_LT(next, std::uint64_t{1} << 32) << "index " << i << " of " << n;
      const auto first = static_cast<std::uint32_t>(next);
      const InversionTable::Sample d = table.sample(first);
      ASSERT_EQ(d.index, i);
      ASSERT_EQ(d.begin, first);
      const auto last = static_cast<std::uint32_t>(next + d.count - 1);
      ASSERT_EQ(table.sample(last).index, i);
      ASSERT_EQ(table.pmf(i).value, float(double(d.count) * 0x1p-32));
      ASSERT_NEAR(double(d.count) * 0x1p-32, weights[i] / sum, double(n) * 0x1p-32);
      next += d.count;
    }
    EXPECT_EQ(next, std::uint64_t{1} << 32);
  }
}

TEST(InversionTable, SizesOfWeightsDoNotMatter) {
  for (const double unit : {1e-300, 1.0, 1e300}) {
    const InversionTable table(std::vector<double>{unit, 0, 3 * unit});
    EXPECT_FLOAT_EQ(table.pmf(0).value, 0.25F);
    EXPECT_FLOAT_EQ(table.pmf(2).value, 0.75F);
  }
}

TEST(InversionTable, NothingToDraw) {
  EXPECT_TRUE(InversionTable().empty());
  EXPECT_TRUE(InversionTable(std::vector<double>{0, 0}).empty());
}

TEST(InversionTable, RefusesWhatIsNoWeight) {
  EXPECT_THROW(InversionTable(std::vector<double>{1, -1}), std::invalid_argument);
  EXPECT_THROW(InversionTable(std::vector<double>{1, std::numeric_limits<double>::quiet_NaN()}),
               std::invalid_argument);
  EXPECT_THROW(InversionTable(std::vector<double>{1, std::numeric_limits<double>::infinity()}),
               std::invalid_argument);
}

}  // namespace
}  // namespace lacuna
