#include "renderer/race/picture_halves.h"

#include <gtest/gtest.h>

#include <random>

#include "base/storage/bytes.h"
#include "renderer/race/plan.h"
#include "renderer/race/race.h"

namespace lacuna {
namespace {

constexpr int halves_width = 64, halves_height = 32;

/// Estimates of `counts` samples of each block, whose deviation is 1, left of the middle 3.
PictureHalves rendered(const BlockGrid& grid, int estimates, const std::vector<int>& counts) {
  PictureHalves halves(grid);
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  for (int i = 0; i < estimates; ++i) {
    Image sums(grid.width, grid.height);
    for (int y = 0; y < grid.height; ++y) {
      for (int x = 0; x < grid.width; ++x) {
        const int n = counts[grid.block_of(x, y)];
        const double deviation = (x < grid.width / 2 ? 3 : 1) * std::sqrt(n);
        sums.at(x, y) = Rgb(float(n + deviation * normal(random)));
      }
    }
    halves.add(std::uint32_t(i % 2), sums, counts);
  }
  return halves;
}

TEST(PictureHalves, TellTheVarianceOfOneIndependentSample) {
  const BlockGrid grid(halves_width, halves_height);
  std::vector<int> counts(grid.blocks(), 1);
  for (std::size_t b = 0; b < counts.size(); ++b) counts[b] = 1 + int(b % 3);
  const PictureHalves halves = rendered(grid, 10, counts);
  const auto found = halves.variances();
  ASSERT_TRUE(found);
  for (std::size_t b = 0; b < grid.blocks(); ++b) {
    const double expected = int(b) % grid.across < grid.across / 2 ? 9 : 1;
    // The mean of 256 squares has a deviation of sqrt(2 / 256).
    EXPECT_NEAR((*found)[b] / (256 * expected), 1, 5 * std::sqrt(2.0 / 256)) << b;
    EXPECT_EQ(halves.drawn(0)[b], std::uint64_t(5 * counts[b]));
  }
  EXPECT_NEAR(halves.samples(), 10 * (1 + 2 + 3) / 3.0, 10 / 8.0);
}

TEST(PictureHalves, SayNothingOfFewEstimates) {
  const BlockGrid grid(halves_width, halves_height);
  const std::vector<int> counts(grid.blocks(), 1);
  EXPECT_FALSE(PictureHalves(grid).variances());
  EXPECT_FALSE(rendered(grid, 7, counts).variances());
  EXPECT_TRUE(rendered(grid, 8, counts).variances());
}

TEST(PictureHalves, AreSaved) {
  const BlockGrid grid(halves_width, halves_height);
  const std::vector<int> counts(grid.blocks(), 2);
  for (const int estimates : {0, 1, 9}) {
    const PictureHalves halves = rendered(grid, estimates, counts);
    ByteWriter out;
    halves.save(out);
    PictureHalves loaded(grid);
    ByteReader in(out.bytes());
    loaded.load(in);
    EXPECT_TRUE(in.at_end());
    EXPECT_EQ(loaded.variances(), halves.variances());
    EXPECT_EQ(loaded.drawn(1), halves.drawn(1));
    PictureHalves other(BlockGrid(16, 16));
    ByteReader again(out.bytes());
    EXPECT_THROW(other.load(again), std::runtime_error);
  }
}

/// A race of one entrant whose one estimate after the other has variance 1 everywhere.
Race observed_race(double observed_left, double observed_right) {
  Race race(1, halves_width, halves_height, {.cost = 1, .budget = 1000});
  Entrant& e = race.entrants()[0];
  e.spreads = true;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 16; ++i) {
    Image estimate(halves_width, halves_height);
    for (Rgb& p : estimate.pixels) p = Rgb(float(normal(random)));
    e.trial.charge(1);
    e.trial.add(estimate);
  }
  race.judge();
  if (observed_left > 0) {
    BlockSums seen(race.grid().blocks());
    for (std::size_t b = 0; b < seen.size(); ++b) {
      const bool left = int(b) % race.grid().across < race.grid().across / 2;
      seen[b] = 256 * (left ? observed_left : observed_right);
    }
    race.observe(0, seen, 16);
    race.judge();
  }
  return race;
}

// Samples are spread so well on the right that nearly all of the error is on the left.
TEST(Plan, FollowsTheErrorThatWasSeen) {
  const PlanFreedom freedom{.cost = 20, .regions = false, .by_block = {1}};
  EXPECT_FALSE(make_plan(observed_race(0, 0), freedom).is_adaptive()) << "nothing was seen yet";
  const Race race = observed_race(1, 0.01);
  const Plan plan = make_plan(race, freedom);
  ASSERT_TRUE(plan.is_adaptive());
  const BlockGrid& grid = race.grid();
  EXPECT_GT(plan.counts[0][grid.block_of(1, 1)], 30);
  EXPECT_LT(plan.counts[0][grid.block_of(halves_width - 1, 1)], 15);
}

TEST(Race, ForeseesFromWhatWasSeen) {
  // Of independent samples the error of one, times cost 1.
  EXPECT_NEAR(observed_race(0, 0).entrants()[0].standing.error, 1, 0.1);
  // A fourth is left after 16: it goes on falling with half of the exponent 1/2.
  const Standing s = observed_race(0.25, 0.25).entrants()[0].standing;
  EXPECT_NEAR(s.error, 0.25 * std::pow(1000 / 16.0, -0.25), 0.02);
}

}  // namespace
}  // namespace lacuna
