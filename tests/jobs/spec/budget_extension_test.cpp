#include <gtest/gtest.h>

#include <string>

#include "jobs/spec/budget_extension.h"

namespace lacuna {
namespace {

Budget budget(std::optional<double> seconds, std::optional<std::int64_t> iterations,
              std::optional<double> target = {}, ErrorMetric metric = ErrorMetric::est_rmse) {
  Budget b;
  b.seconds = seconds;
  b.iterations = iterations;
  if (target) b.error = ErrorTarget{metric, *target};
  return b;
}

bool is_extension(const Budget& old, const Budget& larger) {
  return extension_problems(old, larger).empty();
}

TEST(BudgetExtension, OneLimitThatGrowsOrGoesIsEnough) {
  EXPECT_TRUE(is_extension(budget(60, {}), budget(61, {})));
  EXPECT_TRUE(is_extension(budget({}, 10), budget({}, 11)));
  EXPECT_TRUE(is_extension(budget(60, 10), budget(60, 11)));
  EXPECT_TRUE(is_extension(budget(60, 10), budget(60, {}))) << "a limit goes";
  EXPECT_TRUE(is_extension(budget(60, {}), budget({}, 5))) << "another takes its place";
  EXPECT_TRUE(is_extension(budget({}, 10, 0.1), budget({}, 10, 0.05)));
  EXPECT_TRUE(is_extension(budget({}, 10, 0.1), budget({}, 10)));
  Budget old, larger;
  old.cpu_seconds = 1;
  larger.cpu_seconds = 1.5;
  EXPECT_TRUE(is_extension(old, larger));
  EXPECT_FALSE(is_extension(larger, old));
}

TEST(BudgetExtension, EachProblemIsNamedWithItsPlaceAndTheLimitBefore) {
  const auto problems = extension_problems(budget(60, 10, 0.1), budget(30, 9, 0.2));
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_EQ(problems[0].pointer, "/budget/seconds");
  EXPECT_EQ(problems[0].message, "found 30; allowed: at least 60, the previous limit, or none");
  EXPECT_EQ(problems[1].pointer, "/budget/iterations");
  EXPECT_EQ(problems[1].message, "found 9; allowed: at least 10, the previous limit, or none");
  EXPECT_EQ(problems[2].pointer, "/budget/error/target");
  EXPECT_EQ(problems[2].message, "found 0.2; allowed: at most 0.1, the previous limit, or none");
}

TEST(BudgetExtension, ALimitThatShrinksIsRefusedEvenIfAnotherGrows) {
  const auto problems = extension_problems(budget(60, 10), budget(120, 9));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/budget/iterations");
}

TEST(BudgetExtension, TheSameAgainOrOneLimitMoreIsNoExtension) {
  for (const Budget& same : {budget(60, 10, 0.1), budget(60, 10, 0.1)}) {
    const auto problems = extension_problems(budget(60, 10, 0.1), same);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].pointer, "/budget");
  }
  EXPECT_FALSE(is_extension(budget({}, 10), budget(60, 10)));
  EXPECT_FALSE(is_extension(budget(60, {}), Budget{})) << "no limit at all";
}

TEST(BudgetExtension, ErrorsOfTwoMetricsCannotBeCompared) {
  const auto problems =
      extension_problems(budget({}, 10, 0.1), budget({}, 20, 0.01, ErrorMetric::relmse));
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].pointer, "/budget/error/metric");
  EXPECT_NE(problems[0].message.find("relmse"), std::string::npos);
  EXPECT_NE(problems[0].message.find("est_rmse"), std::string::npos);
}

}  // namespace
}  // namespace lacuna
