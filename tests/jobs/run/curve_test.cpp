#include "jobs/run/curve.h"

#include <gtest/gtest.h>

#include "jobs/run/budget.h"

namespace lacuna {
namespace {

CurveRow row(std::uint64_t iteration, double seconds) {
  CurveRow r;
  r.iteration = iteration;
  r.seconds = seconds;
  return r;
}

TEST(Curve, RowsAreDueAtLogSpacedInstants) {
  Curve curve;
  EXPECT_FALSE(curve.due(0.09));
  int rows = 0;
  // A thousand iterations of 0.1 s: 100 s are about 20 factors of sqrt 2 above 0.1 s.
  for (int i = 1; i <= 1000; ++i) {
    const double t = 0.1 * i + 1e-9;
    if (!curve.due(t)) continue;
    curve.add(row(static_cast<std::uint64_t>(i), t));
    ++rows;
  }
  EXPECT_GE(rows, 17);
  EXPECT_LE(rows, 21);
  for (std::size_t i = 6; i + 1 < curve.rows().size(); ++i) {
    EXPECT_NEAR(curve.rows()[i + 1].seconds / curve.rows()[i].seconds, std::sqrt(2), 0.12);
  }
}

TEST(Curve, ASecondRowOfAnIterationReplacesTheFirst) {
  Curve curve;
  curve.add(row(3, 1));
  curve.add(row(3, 2));
  ASSERT_EQ(curve.rows().size(), 1U);
  EXPECT_EQ(curve.rows()[0].seconds, 2);
}

TEST(Curve, CsvLeavesOutWhatIsNotKnown) {
  Curve curve;
  CurveRow r = row(1, 0.5);
  r.counters.rays = 7;
  curve.add(r);
  r.iteration = 2;
  r.errors = Errors{0.1, 0.5, 0.25, 3, 4};
  r.flip = 0.75;
  r.est_rmse = 0.125;
  r.at_floor = true;
  r.longest_seconds = 0.25;
  curve.add(r);
  EXPECT_EQ(curve.csv(),
            "iteration,seconds,cpu_seconds,samples,rays,shadow_rays,mae,rmse,mse,relmse,smape,"
            "flip,est_rmse,negative,rejected,at_floor,longest_seconds\n"
            "1,0.5,0,0,7,0,,,,,,,,0,0,0,0\n"
            "2,0.5,0,0,7,0,0.10000000000000001,0.5,0.25,3,4,0.75,0.125,0,0,1,0.25\n");
}

TEST(Curve, ComesBackFromACheckpoint) {
  Curve curve;
  curve.add(row(1, 0.5));
  CurveRow r = row(2, 1);
  r.counters = {1, 2, 3, 4, 5};
  r.errors = Errors{0.1, 0.5, 0.25, 3, 4};
  r.flip = 0.75;
  r.est_rmse = 0.125;
  r.at_floor = true;
  r.longest_seconds = 0.25;
  curve.add(r);
  ByteWriter out;
  curve.save(out);
  ByteReader in(out.bytes());
  Curve again;
  again.load(in);
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(again.csv(), curve.csv());
  EXPECT_EQ(again.rows().size(), 2U);
}

TEST(Curve, ASavedFlagIsZeroOrOne) {
  Curve curve;
  curve.add(row(1, 0.5));
  ByteWriter out;
  curve.save(out);
  std::string bytes = out.take();
  bytes.back() = 2;  // at_floor
  ByteReader in(bytes);
  EXPECT_THROW(curve.load(in), std::runtime_error);
}

TEST(Budget, FirstLimitReachedEndsIt) {
  Budget b;
  b.seconds = 10;
  b.iterations = 5;
  EXPECT_FALSE(exhausted(b, {4, 9.9, 9.9}));
  EXPECT_TRUE(exhausted(b, {5, 1, 1}));
  EXPECT_TRUE(exhausted(b, {1, 10, 1}));
  EXPECT_DOUBLE_EQ(share(b, {4, 2, 2}), 0.8);
  Budget cpu;
  cpu.cpu_seconds = 3;
  EXPECT_FALSE(exhausted(cpu, {1, 100, 2.9}));
  EXPECT_TRUE(exhausted(cpu, {1, 100, 3}));
}

TEST(Budget, DoesNotBeginWhatCannotEndInTime) {
  Budget b;
  b.seconds = 10;
  EXPECT_FALSE(would_overrun(b, {0, 0, 0}));
  EXPECT_FALSE(would_overrun(b, {4, 8, 0}));
  EXPECT_TRUE(would_overrun(b, {4, 8.1, 0}));
}

TEST(Budget, ErrorTargetLooksAtTheLatestRow) {
  Budget b;
  b.error = ErrorTarget{ErrorMetric::relmse, 0.1};
  Curve curve;
  EXPECT_FALSE(target_met(b, curve));
  CurveRow r = row(1, 1);
  curve.add(r);
  EXPECT_FALSE(target_met(b, curve));
  r.iteration = 2;
  r.errors = Errors{0, 0, 0, 0.1, 0};
  curve.add(r);
  EXPECT_TRUE(target_met(b, curve));
}

}  // namespace
}  // namespace lacuna
