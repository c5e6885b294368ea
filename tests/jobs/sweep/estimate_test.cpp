#include "jobs/sweep/estimate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "jobs/sweep/distributions.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

TEST(Student, InClosedForm) {
  for (const double t : {0.01, 0.5, 1.0, 2.0, 4.303, 12.0, 100.0}) {
    const double of_1 = 2 / std::numbers::pi * std::atan(t), of_2 = t / std::sqrt(2 + t * t);
    EXPECT_NEAR(student_within(t, 1) / of_1, 1, 1e-12) << "t " << t;
    EXPECT_NEAR(student_within(t, 2) / of_2, 1, 1e-12) << "t " << t;
    EXPECT_NEAR(student_beyond(t, 2) / (1 - of_2), 1, 1e-11) << "t " << t;
    EXPECT_NEAR(student_bound(of_1, 1) / t, 1, 1e-12) << "t " << t;
    EXPECT_NEAR(student_bound(of_2, 2) / t, 1, 1e-12) << "t " << t;
  }
  for (const double df : {1.3, 7.5, 400.0})
    EXPECT_NEAR(student_within(student_bound(0.95, df), df), 0.95, 1e-12) << "df " << df;
}

TEST(Student, BoundsAsTabulated) {
  // Fisher and Yates, Statistical Tables, two-sided 95 %.
  EXPECT_NEAR(student_bound(0.95, 1), 12.7062, 1e-4);
  EXPECT_NEAR(student_bound(0.95, 2), 4.3027, 1e-4);
  EXPECT_NEAR(student_bound(0.95, 9), 2.2622, 1e-4);
  EXPECT_NEAR(student_bound(0.95, 1e4), 1.9602, 1e-4);
  EXPECT_THROW(student_bound(1, 3), std::domain_error);
  EXPECT_THROW(student_bound(0.95, 0), std::domain_error);
}

TEST(GeometricMean, OfOneThereIsNoInterval) {
  const std::array one{3.0};
  EXPECT_DOUBLE_EQ(geometric_mean(one).value, 3);
  EXPECT_FALSE(geometric_mean(one).interval);
  EXPECT_THROW(geometric_mean({}), std::domain_error);
  const std::array zero{1.0, 0.0};
  EXPECT_THROW(geometric_mean(zero), std::domain_error);
}

TEST(GeometricMean, ByHand) {
  const std::array values{1.0, 2.0, 4.0};
  const Estimate e = geometric_mean(values);
  EXPECT_NEAR(e.value, 2, 1e-12);
  const double half = 4.30265273 * std::log(2.0) / std::sqrt(3.0);
  EXPECT_NEAR(e.interval->low, 2 * std::exp(-half), 1e-6);
  EXPECT_NEAR(e.interval->high, 2 * std::exp(half), 1e-6);
}

/// How often, of `trials`, the interval of small groups holds the truth; and p-values of the
/// hypotheses that it does with the probability it says, and with one above or below `share`.
struct Coverage {
  int trials = 0, held = 0;
  void count(const std::optional<Interval>& i, double truth) {
    ++trials;
    held += i->low <= truth && truth <= i->high ? 1 : 0;
  }
  double p() const { return statistics::two_sided_p(beyond(confidence)); }
  double at_least_p(double share) const { return statistics::upper_p(-beyond(share)); }
  double at_most_p(double share) const { return statistics::upper_p(beyond(share)); }

 private:
  double beyond(double share) const {
    return (held / static_cast<double>(trials) - share) / std::sqrt(share * (1 - share) / trials);
  }
};

TEST(Intervals, HoldTheTruthAsOftenAsTheySay) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto group = [&](std::size_t n, double centre, double spread) {
    std::vector<double> values;
    for (std::size_t i = 0; i < n; ++i)
      values.push_back(std::exp(centre + spread * normal(random)));
    return values;
  };
  Coverage of_means, of_equal_spread, of_plain;
  for (int i = 0; i < 4000; ++i) {
    const auto a = group(3, -5, 0.4), b = group(3, -4, 0.4);
    of_means.count(geometric_mean(a).interval, std::exp(-5));
    of_equal_spread.count(ratio_of_means(a, b).interval, std::exp(-1));
    std::vector<double> logs;
    for (const double v : group(4, 0, 1)) logs.push_back(std::log(v));
    of_plain.count(mean(logs).interval, 0);
  }
  const double level = statistics::sidak(1e-4, 4);
  EXPECT_GT(of_means.p(), level) << of_means.held << " of " << of_means.trials;
  EXPECT_GT(of_plain.p(), level) << of_plain.held << " of " << of_plain.trials;
  // Welch's interval is approximate, and on the safe side for groups of three.
  EXPECT_GT(of_equal_spread.at_least_p(confidence), level) << of_equal_spread.held;
  EXPECT_GT(of_equal_spread.at_most_p(0.98), level) << of_equal_spread.held;
}

TEST(RatioOfMeans, WithVeryDifferentSpread) {
  const std::array tight{1.0, 1.0, 1.0}, wide{1.0, 2.0, 4.0};
  const Estimate e = ratio_of_means(wide, tight);
  const Estimate alone = geometric_mean(wide);
  EXPECT_NEAR(e.value, 2, 1e-12);
  EXPECT_NEAR(e.interval->low, alone.interval->low, 1e-6);  // all of the spread is one group's
  const Estimate same = ratio_of_means(tight, tight);
  EXPECT_EQ(same.interval->low, 1);
  EXPECT_EQ(same.interval->high, 1);
  const std::array one{1.0};
  EXPECT_FALSE(ratio_of_means(wide, one).interval);
}

// By a table of Student's factors.
TEST(Estimate, ValuesThatHalveAnInterval) {
  EXPECT_EQ(samples_for_half(3), 5u);    // 4.303 / sqrt(3) = 2.484; 2.776 / sqrt(5) = 1.2416
  EXPECT_EQ(samples_for_half(10), 33u);  // 2.262 / sqrt(10) = 0.7153; 2.037 / sqrt(33) = 0.3546
  EXPECT_EQ(samples_for_half(2), 3u);    // 12.71 / sqrt(2) = 8.98; 4.303 / sqrt(3) = 2.484
  EXPECT_LE(samples_for_half(1000), 4000u);
  EXPECT_GT(samples_for_half(1000), 3990u);
  EXPECT_THROW(samples_for_half(1), std::domain_error);
}

}  // namespace
}  // namespace lacuna
