// Races that are too short for whole pictures have smaller ones.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/storage/bytes.h"
#include "renderer/race/race.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

constexpr int film_width = 250, film_height = 130;

/// Pixels that are 1, with noise.
Image noisy(const BlockGrid& grid, double deviation, std::mt19937_64& random) {
  std::normal_distribution<double> normal(1, deviation);
  Image image(grid.trial_width(), grid.trial_height());
  for (Rgb& p : image.pixels) {
    const float r = float(normal(random)), g = float(normal(random)), b = float(normal(random));
    p = Rgb(r, g, b);
  }
  return image;
}

BlockGrid grid_of(int reduction) {
  BlockGrid grid(film_width, film_height);
  grid.reduction = reduction;
  return grid;
}

Race race_of(double budget, std::size_t entrants = 2) {
  return {entrants, film_width, film_height, RaceLimits::of_seconds(budget)};
}

TEST(Reduction, EveryPixelOfTheFilmIsInATrialsPixel) {
  for (const int reduction : {1, 2, 3, 7, 1000}) {
    const BlockGrid grid = grid_of(reduction);
    std::vector<double> found(grid.blocks()), expected(grid.blocks());
    for (int y = 0; y < grid.trial_height(); ++y) {
      for (int x = 0; x < grid.trial_width(); ++x) found[grid.block_of(x, y)] += grid.weight(x, y);
    }
    const BlockGrid whole = grid_of(1);
    for (int y = 0; y < film_height; ++y) {
      for (int x = 0; x < film_width; ++x) ++expected[whole.block_of(x, y)];
    }
    double all = 0;
    for (std::size_t b = 0; b < found.size(); ++b) {
      all += found[b];
      if (16 % reduction == 0) {
        EXPECT_EQ(found[b], expected[b]) << b;
      }
    }
    EXPECT_EQ(all, double(film_width) * film_height) << reduction;
  }
}

TEST(Reduction, TrialsOfSmallerPicturesTellThePicturesError) {
  statistics::Moments whole, smaller;
  std::mt19937_64 random(1);
  for (int n = 0; n < 100; ++n) {
    for (const int reduction : {1, 3}) {
      Trial trial(film_width, film_height, reduction);
      for (int i = 0; i < 3; ++i) {
        trial.add(noisy(trial.grid(), 2, random));
        trial.charge(5 * trial.grid().trial_share(), trial.grid().trial_share());
      }
      (reduction == 1 ? whole : smaller).add(total(trial.variances()));
      EXPECT_NEAR(trial.iteration_cost(), 5, 1e-9);
      EXPECT_NEAR(trial.next_cost(), 5 * trial.grid().trial_share(), 1e-9);
    }
  }
  for (const auto& m : {whole, smaller}) {
    const double expected = 4.0 * film_width * film_height;
    EXPECT_LT(std::abs(m.mean() - expected), 4 * m.standard_error());
    EXPECT_LT(m.standard_error(), 0.01 * expected);
  }
}

TEST(Reduction, IsAsLittleAsTheRaceCanAfford) {
  // Two entrants of which an iteration of the whole film costs 1 and 3.
  const auto reduction = [](double budget) {
    Race race = race_of(budget);
    const BlockGrid probe = grid_of(5);
    const std::vector<double> costs{probe.trial_share(), 3 * probe.trial_share()};
    EXPECT_TRUE(race.wants_smaller_pictures());
    race.choose_reduction(costs, probe.reduction);
    EXPECT_FALSE(race.wants_smaller_pictures()) << "once";
    const double rest = RaceLimits::of_seconds(budget).cost - 4 * probe.trial_share();
    EXPECT_NEAR(race.limits().cost, std::max(0.0, rest), 1e-12);
    const BlockGrid found = grid_of(race.reduction());
    if (found.trial_pixels() > 4096) {
      EXPECT_LE(16 * 4 * found.trial_share(), rest);
    }
    if (race.reduction() > 1) {
      EXPECT_GT(16 * 4 * grid_of(race.reduction() - 1).trial_share(), rest);
    }
    EXPECT_EQ(race.entrants()[1].trial.grid().reduction, race.reduction());
    return race.reduction();
  };
  EXPECT_EQ(reduction(1e6), 1);
  const int long_race = reduction(3e4), shorter = reduction(3e3), at_nothing = reduction(1e-3);
  EXPECT_GT(shorter, long_race);
  EXPECT_GE(at_nothing, shorter);
  EXPECT_GE(grid_of(at_nothing).trial_pixels(), 2048) << "and no smaller";
}

TEST(Reduction, WhatIsSlowInSmallPicturesLeaves) {
  Race race = race_of(100, 3);
  const double slow = RaceLimits::of_seconds(100).cost / 10;
  race.choose_reduction(std::vector<double>{0.001, slow, 0.002}, 5);
  EXPECT_TRUE(race.entrants()[0].racing);
  EXPECT_FALSE(race.entrants()[1].racing);
  EXPECT_EQ(race.entrants()[1].reason, "an iteration takes too long for the race");
  EXPECT_TRUE(race.entrants()[2].racing);
  EXPECT_EQ(race.reduction(), 1) << "it does not count";
}

TEST(Reduction, BiasNeedsWholePictures) {
  const Race race(2, film_width, film_height, RaceLimits::of_seconds(1), {0, 1});
  EXPECT_FALSE(race.wants_smaller_pictures());
}

/// A race of a budget in which no whole picture fits, of entrants with these deviations, that cost
/// 1 and 3 a picture.
Race short_race(const std::vector<double>& deviations, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Race race = race_of(60, deviations.size());
  const double of_probe = grid_of(8).trial_share();
  std::vector<double> costs;
  for (std::size_t k = 0; k < deviations.size(); ++k) {
    costs.push_back(of_probe * double(1 + 2 * k));
  }
  race.choose_reduction(costs, 8);
  EXPECT_GT(race.reduction(), 1);
  const double share = grid_of(race.reduction()).trial_share();
  while (const auto k = race.next()) {
    race.finished(*k, noisy(race.entrants()[*k].trial.grid(), deviations[*k], random),
                  share * double(1 + 2 * *k));
  }
  race.close();
  EXPECT_LE(race.spent(), RaceLimits::of_seconds(60).cost * (1 + 1e-9));
  EXPECT_LT(race.spent(), 2) << "no whole picture of both, let alone two";
  return race;
}

TEST(Reduction, ShortRacesFindTheBest) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(short_race({4, 1}, seed).best(), 1U);
    EXPECT_EQ(short_race({1, 1}, seed).best(), 0U) << "for a third of the cost";
  }
}

TEST(Reduction, SharedStartsMakeLessNoiseInWholePictures) {
  std::mt19937_64 random(1);
  Race race = race_of(60);
  race.entrants()[1].shares_starts = true;
  race.choose_reduction(std::vector<double>{0.06, 0.06}, 8);
  const int reduction = race.reduction();
  ASSERT_GT(reduction, 1);
  while (const auto k = race.next()) {
    race.finished(*k, noisy(race.entrants()[*k].trial.grid(), 1, random), 0.1);
  }
  race.close();
  EXPECT_EQ(race.best(), 1U);
  EXPECT_NEAR(race.entrants()[1].standing.over_best.value, 0, 1e-12);
  EXPECT_NEAR(race.entrants()[0].standing.over_best.value, std::log(reduction), 0.1);
}

TEST(Reduction, WholePicturesBeginAnew) {
  std::mt19937_64 random(1);
  Race race = short_race({4, 1}, 1);
  Trial& trial = race.entrants()[1].trial;
  const std::uint64_t iterations = trial.iterations();
  const double cost = trial.cost();
  trial.restart_whole();
  EXPECT_EQ(trial.iterations(), iterations) << "they are numbered on";
  EXPECT_EQ(trial.estimates(), 0U);
  EXPECT_EQ(trial.grid(), race.grid());
  for (int i = 0; i < 6; ++i) {
    trial.charge(2);
    trial.add(noisy(trial.grid(), 1, random));
  }
  EXPECT_NEAR(trial.iteration_cost(), 2, 1e-9);
  EXPECT_NEAR(trial.cost(), cost + 12, 1e-9);
  race.judge();
  EXPECT_NEAR(race.entrants()[1].standing.error, 2, 0.2);
}

TEST(Reduction, IsSavedWithTheRace) {
  std::mt19937_64 random(1);
  Race race = race_of(20);
  race.choose_reduction(std::vector<double>{0.001, 0.003}, 8);
  const std::size_t first = *race.next();
  race.entrants()[first].spreads = true;
  race.finished(first, noisy(race.entrants()[0].trial.grid(), 1, random), 0.01);
  race.entrants()[1].trial.restart_whole();
  race.entrants()[1].trial.charge(1);
  ByteWriter out;
  race.save(out);
  Race loaded = race_of(20);
  ByteReader in(out.bytes());
  loaded.load(in);
  EXPECT_EQ(loaded.reduction(), race.reduction());
  EXPECT_EQ(loaded.entrants()[0].trial.grid(), race.entrants()[0].trial.grid());
  EXPECT_EQ(loaded.entrants()[1].trial.grid().reduction, 1);
  EXPECT_EQ(loaded.next(), race.next());
  ByteWriter again;
  loaded.save(again);
  EXPECT_EQ(again.bytes(), out.bytes());
}

}  // namespace
}  // namespace lacuna
