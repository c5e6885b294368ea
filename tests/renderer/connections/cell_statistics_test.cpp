#include "renderer/connections/cell_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lacuna {
namespace {

/// Of cell 1, `n` vertices joined to paths of two vertices, each of which gave `value`.
CellStatistics::Accumulator accumulator_of(int n, double value, double survival = 1) {
  CellStatistics::Accumulator t(3);
  for (int i = 0; i < n; ++i) {
    t.visit(1);
    t.attempt(1, 2);
    t.add_contribution(1, 2, value, survival);
  }
  t.add_path_sum(n * value);
  t.add_paths(static_cast<std::uint64_t>(n));
  t.close();
  return t;
}

CellStatistics statistics_of(std::vector<CellStatistics::Accumulator> accumulators) {
  CellStatistics s;
  s.resize(3);
  s.add(accumulators);
  return s;
}

std::string saved(const CellStatistics& s) {
  ByteWriter out;
  s.save(out);
  return out.take();
}

TEST(CellStatistics, NothingIsLeftOutBeforeItIsKnown) {
  CellStatistics s;
  s.resize(3);
  EXPECT_EQ(s.survival(1, 2, 1e-9, 1), 1);
  s.add(std::vector{accumulator_of(31, 0.001)});
  EXPECT_EQ(s.survival(1, 2, 1e-9, 1), 1);
  s.add(std::vector{accumulator_of(1, 0.001)});
  EXPECT_LT(s.survival(1, 2, 1e-9, 1), 1);
  EXPECT_EQ(s.survival(1, 3, 1e-9, 1), 1);
  EXPECT_EQ(s.survival(0, 2, 1e-9, 1), 1);
  EXPECT_EQ(s.survival(1, 2, 1e-9, 0), 1);
}

TEST(CellStatistics, SurvivalIsWhatIsExpectedOverWhatIsEnough) {
  const CellStatistics s = statistics_of({accumulator_of(100, 3)});
  EXPECT_FLOAT_EQ(s.survival(1, 2, 0.5, 2), 0.75F);
  EXPECT_EQ(s.survival(1, 2, 0.5, 1.4), 1);
  EXPECT_FLOAT_EQ(s.survival(1, 2, 0.001, 2), 0.05F);
  EXPECT_EQ(s.survival(1, 2, 0, 2), 0.05F);
}

TEST(CellStatistics, WhatWasSeldomMadeCountsAsOftenAsItStandsFor) {
  CellStatistics::Accumulator t(3);
  for (int i = 0; i < 400; ++i) {
    t.attempt(1, 2);
    if (i % 4 == 0) t.add_contribution(1, 2, 3, 0.25);
  }
  t.close();
  EXPECT_FLOAT_EQ(statistics_of({std::move(t)}).survival(1, 2, 0.5, 2), 0.75F);
}

TEST(CellStatistics, LongPathsShareOneClass) {
  CellStatistics::Accumulator t(3);
  for (int s = 8; s < 48; ++s) {
    t.attempt(2, s);
    t.add_contribution(2, s, 1, 1);
  }
  t.close();
  const CellStatistics all = statistics_of({std::move(t)});
  EXPECT_FLOAT_EQ(all.survival(2, 1000, 0.5, 1), 0.5F);
  EXPECT_EQ(all.survival(2, 7, 0.5, 1), 1);
}

TEST(CellStatistics, TilesHaveTheirOwnMeans) {
  const CellStatistics s =
      statistics_of({accumulator_of(10, 3), accumulator_of(10, 5), accumulator_of(0, 0)});
  EXPECT_DOUBLE_EQ(s.mean(0), 3);
  EXPECT_DOUBLE_EQ(s.mean(1), 5);
  EXPECT_EQ(s.mean(2), 0);
  EXPECT_EQ(s.mean(3), 0);
  EXPECT_EQ(s.visits(1), 20U);
  EXPECT_EQ(s.visits(0), 0U);
}

TEST(CellStatistics, CellsAddUpOverTilesAndIterations) {
  CellStatistics s = statistics_of({accumulator_of(16, 3), accumulator_of(16, 3)});
  EXPECT_FLOAT_EQ(s.survival(1, 2, 0.5, 2), 0.75F);
  s.add(std::vector{accumulator_of(96, 1)});
  EXPECT_FLOAT_EQ(s.survival(1, 2, 0.5, 2), static_cast<float>(0.25 * std::sqrt(3.0)));
  EXPECT_EQ(s.visits(1), 128U);
}

TEST(CellStatistics, AreSavedAndRead) {
  const CellStatistics s = statistics_of({accumulator_of(100, 3), accumulator_of(10, 5)});
  const std::string bytes = saved(s);
  CellStatistics again;
  again.resize(3);
  ByteReader in(bytes);
  again.load(in);
  EXPECT_TRUE(in.at_end());
  EXPECT_EQ(saved(again), bytes);
  EXPECT_EQ(again.survival(1, 2, 0.5, 2), s.survival(1, 2, 0.5, 2));
  EXPECT_EQ(again.mean(1), s.mean(1));

  CellStatistics other;
  other.resize(4);
  ByteReader same(bytes);
  EXPECT_THROW(other.load(same), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
