#include "jobs/sweep/compare.h"

#include <gtest/gtest.h>

#include <cmath>

#include "jobs/sweep/front.h"

namespace lacuna {
namespace {

/// c / t at 1, 2, 4 ... 2^(n - 1).
ErrorCurve falling(double c, int n = 7, double first = 1) {
  std::vector<CurvePoint> points;
  points.reserve(static_cast<std::size_t>(n));
  for (int i = 0; i < n; ++i) points.push_back({first * std::exp2(i), c / (first * std::exp2(i))});
  const double last = points.back().time;
  return {std::move(points), last};
}

TEST(ErrorCurve, LinesInLogLog) {
  const ErrorCurve curve = falling(8);
  EXPECT_NEAR(curve.at(3)->error, 8.0 / 3, 1e-12);
  EXPECT_EQ(curve.at(4)->error, 2);
  EXPECT_FALSE(curve.at(0.99));
  EXPECT_FALSE(curve.at(64.1));
  EXPECT_NEAR(curve.reaches(3)->time, 8.0 / 3, 1e-12);
  EXPECT_FALSE(curve.reaches(3)->at_most);
  EXPECT_TRUE(curve.reaches(9)->at_most);
  EXPECT_FALSE(curve.reaches(0.1));
}

TEST(ErrorCurve, AnErrorIsReachedOnceItIsKept) {
  // Black at first, then the first bright paths, then convergence.
  const ErrorCurve curve({{1, 0.9}, {2, 400}, {4, 100}, {8, 25}, {16, 0.5}}, 16);
  EXPECT_EQ(curve.reaches(100)->time, 4);
  EXPECT_NEAR(curve.reaches(50)->time, std::sqrt(32.0), 1e-12);
  EXPECT_GT(curve.reaches(0.9)->time, 8);
  EXPECT_FALSE(curve.reaches(0.4));
  EXPECT_TRUE(curve.reaches(400)->at_most);
  EXPECT_FALSE(ErrorCurve({{1, 0.5}, {2, 400}}, 2).reaches(1));
}

TEST(ErrorCurve, TheLastPictureIsWhatOneHasUntilTheNext) {
  const ErrorCurve curve({{1, 4}, {2, 2}}, 2.5);
  EXPECT_EQ(curve.at(2.5)->error, 2);
  EXPECT_FALSE(curve.at(2.6));
  EXPECT_TRUE(ErrorCurve().empty());
  EXPECT_FALSE(ErrorCurve().at(1));
  EXPECT_FALSE(ErrorCurve().reaches(1));
}

TEST(ErrorAtTime, IsThereIfEveryRunHasOne) {
  const std::vector cell{falling(8), falling(2)}, baseline{falling(16), falling(16)};
  const ErrorAtTime at = error_at_time(cell, baseline, 4);
  EXPECT_NEAR(at.error->value, 1, 1e-12);
  EXPECT_NEAR(at.gain->ratio.value, 4, 1e-12);
  EXPECT_TRUE(at.gain->ratio.interval);
  const std::vector shorter{falling(8), falling(2, 3)};
  const ErrorAtTime partly = error_at_time(shorter, baseline, 8);
  EXPECT_EQ(partly.reached, 1u);
  EXPECT_FALSE(partly.error);
  EXPECT_FALSE(partly.gain);
  EXPECT_FALSE(error_at_time(cell, {}, 4).gain);
}

TEST(TimeToError, OfRunsThatNeverReachItIsABound) {
  const std::vector cell{falling(2), falling(2)}, baseline{falling(16, 4), falling(16)};
  const TimeToError to = time_to_error(cell, baseline, 1);
  EXPECT_NEAR(to.time->value, 2, 1e-12);
  EXPECT_TRUE(to.speed_up->at_least);  // one of the baseline's runs ended at 8 s without it
  EXPECT_NEAR(to.speed_up->ratio.value, 4, 1e-12);
  EXPECT_FALSE(to.speed_up->ratio.interval);
  const TimeToError theirs = time_to_error(baseline, {}, 1);
  EXPECT_EQ(theirs.reached, 1u);
  EXPECT_FALSE(theirs.time);
  EXPECT_EQ(theirs.at_least, 8);
}

TEST(TimeToError, BeforeTheFirstInstantIsABound) {
  const std::vector quick{falling(0.5), falling(0.25)}, slow{falling(16), falling(16)};
  const TimeToError to = time_to_error(quick, slow, 1);
  EXPECT_TRUE(to.at_most);
  EXPECT_TRUE(to.speed_up->at_least);
  EXPECT_NEAR(to.speed_up->ratio.value, 16, 1e-12);
  EXPECT_FALSE(time_to_error(slow, quick, 1).speed_up);  // the baseline's time is not known
}

TEST(TimeToError, ABoundOfOneRunMakesTheMeanABound) {
  const std::vector first{falling(0.5), falling(4)}, last{falling(4), falling(0.5)};
  EXPECT_TRUE(time_to_error(first, {}, 1).at_most);
  EXPECT_TRUE(time_to_error(last, {}, 1).at_most);
  EXPECT_FALSE(time_to_error(first, {}, 0.25).at_most);
}

TEST(Floor, OfOneRunIsToldOfAll) {
  const std::vector cell{falling(8), ErrorCurve({{1, 8}, {4, 2, true}}, 4)};
  EXPECT_FALSE(error_at_time(cell, {}, 1).at_floor);
  EXPECT_TRUE(error_at_time(cell, {}, 4).at_floor);
  EXPECT_TRUE(time_to_error(cell, {}, 3).at_floor);
}

TEST(MeanCurve, WhereAllRunsHaveAnError) {
  const std::vector cell{falling(8, 5), falling(2, 7, 2)};  // from 1 to 16, from 2 to 128
  const auto band = mean_curve(cell);
  EXPECT_DOUBLE_EQ(band.front().time, 2);
  EXPECT_DOUBLE_EQ(band.back().time, 16);
  for (const BandPoint& p : band) {
    EXPECT_NEAR(p.error.value, 4 / p.time, 1e-9);
    EXPECT_LT(p.error.interval->low, p.error.value);
  }
  EXPECT_TRUE(mean_curve({}).empty());
  const std::vector apart{falling(1, 2), falling(1, 2, 100)};
  EXPECT_TRUE(mean_curve(apart).empty());
}

TEST(Front, TheSmallestErrorAtEachTime) {
  // One falls as 1 / t, the other begins at half and then hardly falls: they cross at 4 s.
  const std::vector steep{falling(4), falling(4)};
  const ErrorCurve flat_run({{0.5, 1}, {64, 1}}, 64);
  const std::vector flat{flat_run, flat_run};
  const std::vector<Contender> both{{steep, 0}, {flat, 0}};
  const auto front = pareto_front(both);
  ASSERT_EQ(front.size(), 2u);
  EXPECT_EQ(front[0].best, 1u);
  EXPECT_EQ(front[0].from, 0.5);
  EXPECT_EQ(front[1].best, 0u);
  EXPECT_NEAR(front[1].from, 4, 4 * 0.42);  // instants are sqrt(2) apart
  EXPECT_EQ(front[1].to, 64);
  EXPECT_DOUBLE_EQ(front[1].error, 4.0 / 64);
}

TEST(Front, PreparationIsPaidFirst) {
  const std::vector quick{falling(4), falling(4)}, slow{falling(16), falling(16)};
  const std::vector<Contender> both{{quick, 20}, {slow, 0}};
  const auto front = pareto_front(both);
  ASSERT_EQ(front.size(), 2u);
  EXPECT_EQ(front[0].best, 1u);
  EXPECT_EQ(front[1].best, 0u);
  EXPECT_GT(front[1].from, 20);
  EXPECT_EQ(front[1].to, 84);
}

TEST(Front, WhatCannotBeToldApartIsTied) {
  const std::vector a{falling(1), falling(2), falling(4)},
      b{falling(1.5), falling(2.5), falling(3)};
  const std::vector far{falling(100), falling(101), falling(99)};
  const auto front = pareto_front(std::vector<Contender>{{a, 0}, {b, 0}, {far, 0}});
  ASSERT_EQ(front.size(), 1u);
  EXPECT_EQ(front[0].tied, std::vector<std::size_t>{1 - front[0].best});
  EXPECT_TRUE(pareto_front({}).empty());
}

TEST(Front, IsAtTheFloorIfAnyInstantOfItIs) {
  const ErrorCurve run({{1, 8}, {2, 4, true}, {4, 2}, {8, 1}}, 8);
  const ErrorCurve sound({{1, 8}, {2, 4}, {4, 2}, {8, 1}}, 8);
  const auto front = [](const ErrorCurve& curve) {
    const std::vector cell{curve, curve};
    return pareto_front(std::vector<Contender>{{cell, 0}});
  };
  ASSERT_EQ(front(run).size(), 1u);
  EXPECT_TRUE(front(run)[0].at_floor);
  EXPECT_FALSE(front(sound)[0].at_floor);
}

TEST(BreakEven, WhenPreparationHasPaid) {
  // 16 / t against 4 / (t - 6): equal at t = 8.
  const std::vector base{falling(16)}, cell{falling(4)};
  const auto paid = break_even({cell, 6}, {base, 0});
  ASSERT_TRUE(paid);
  EXPECT_NEAR(paid->seconds, 8, 0.3);
  EXPECT_FALSE(paid->from_the_start);
  EXPECT_TRUE(break_even({cell, 0}, {base, 0})->from_the_start);
  EXPECT_FALSE(break_even({base, 6}, {cell, 0}));
  EXPECT_FALSE(break_even({cell, 100}, {base, 0}));  // nothing measured at a common time
}

}  // namespace
}  // namespace lacuna
