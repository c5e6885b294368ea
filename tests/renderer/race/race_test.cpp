#include "renderer/race/race.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <random>

#include "base/storage/bytes.h"
#include "renderer/race/mixture.h"
#include "renderer/race/plan.h"
#include "tests/statistics.h"

namespace lacuna {
namespace {

constexpr int width = 256, height = 32;

/// A method whose pixels are 1 with noise of a standard deviation that depends on x.
struct Noisy {
  std::function<double(int x)> deviation;
  double cost = 1;
  float mean = 1;
};

class Pictures {
 public:
  explicit Pictures(std::uint64_t seed) : random_(seed) {}
  Image operator()(const Noisy& method) {
    Image image(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const auto value = [&] {
          return method.mean + float(normal_(random_) * method.deviation(x));
        };
        const float r = value(), g = value(), b = value();
        image.at(x, y) = Rgb(r, g, b);
      }
    }
    return image;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

Noisy even(double deviation, double cost = 1) {
  return {[deviation](int) { return deviation; }, cost};
}

/// Races until it is over.
Race raced(const std::vector<Noisy>& methods, std::uint64_t seed, const RaceLimits& limits) {
  Race race(methods.size(), width, height, limits);
  Pictures pictures(seed);
  while (const auto k = race.next()) race.finished(*k, pictures(methods[*k]), methods[*k].cost);
  race.close();
  return race;
}

TEST(Trial, VarianceIsUnbiased) {
  statistics::Moments all, halves[2];
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Pictures pictures(seed);
    Trial trial(width, height);
    for (int i = 0; i < 4; ++i) trial.add(pictures(even(3)));
    all.add(total(trial.variances()));
    for (int h : {0, 1}) halves[h].add(total(trial.variances(h)));
  }
  const double expected = 9.0 * width * height;
  for (const auto& m : {all, halves[0], halves[1]}) {
    EXPECT_LT(std::abs(m.mean() - expected), 4 * m.standard_error());
    EXPECT_LT(m.standard_error(), 0.01 * expected);
  }
}

TEST(Trial, SinglesTellTheirVariancesTogether) {
  const std::vector<double> deviations{1, 2, 0.5, 8};
  std::vector<statistics::Moments> found(deviations.size());
  const BlockGrid grid(width, height);
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    Pictures pictures(seed);
    std::vector<Image> images;
    for (const double d : deviations) images.push_back(pictures(even(d)));
    std::vector<const Image*> pointers;
    for (const Image& i : images) pointers.push_back(&i);
    const auto variances = variances_of_singles(grid, pointers);
    for (std::size_t k = 0; k < found.size(); ++k) found[k].add(total(variances[k]));
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    const double expected = deviations[k] * deviations[k] * width * height;
    EXPECT_LT(std::abs(found[k].mean() - expected), 4 * found[k].standard_error()) << k;
  }
}

TEST(Noise, RatiosKnowTheirDeviation) {
  statistics::Moments squares;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Pictures pictures(seed);
    Trial a(width, height), b(width, height);
    for (int i = 0; i < 3; ++i) {
      a.add(pictures(even(1)));
      b.add(pictures(even(2)));
    }
    const LogRatio r = log_ratio(a.grid(), a.variances(), b.variances());
    const double z = (r.value - std::log(0.25)) / r.deviation;
    squares.add(z * z);
  }
  EXPECT_NEAR(squares.mean(), 1, 4 * squares.standard_error());
}

TEST(Noise, ADifferenceThatNoNoiseExplainsIsFound) {
  Pictures pictures(3);
  Noisy blind = even(0.05);
  blind.mean = 0.5F;
  const std::vector<Noisy> methods{blind, even(0.3), even(0.6)};
  std::vector<Trial> trials(methods.size(), Trial(width, height));
  std::vector<const Trial*> pointers;
  std::vector<BlockSums> variances;
  for (std::size_t k = 0; k < methods.size(); ++k) {
    for (int i = 0; i < 5; ++i) trials[k].add(pictures(methods[k]));
    pointers.push_back(&trials[k]);
    variances.push_back(trials[k].variances());
  }
  const BlockGrid& grid = trials[0].grid();
  const BlockSums found = unexplained_error(pointers, variances, 0);
  EXPECT_NEAR(total(found), 0.25 * width * height, 4 * standard_deviation(grid, found));
  // Methods that agree differ by their noise alone.
  const std::vector<const Trial*> sound{pointers[1], pointers[2]};
  const std::vector<BlockSums> of_sound{variances[1], variances[2]};
  const BlockSums none = unexplained_error(sound, of_sound, 0);
  EXPECT_LT(std::abs(total(none)), 4 * standard_deviation(grid, none));
}

// Few pictures of many are far noisier than the rest: those that are still to come count.
TEST(Trial, ForeseesWhatIsStillToCome) {
  statistics::Moments even_growth, heavy_growth;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Pictures pictures(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> uniform;
    Trial same(width, height), heavy(width, height);
    for (int i = 0; i < 64; ++i) {
      same.add(pictures(even(1)));
      // Squared errors with a tail of index 0.9.
      heavy.add(pictures(even(std::pow(1 - uniform(random), -0.45))));
    }
    even_growth.add(same.growth(1000));
    heavy_growth.add(heavy.growth(1000));
  }
  EXPECT_LT(even_growth.mean(), 1.05);
  EXPECT_GT(heavy_growth.mean(), 1.3);
}

// Left method a is better, right method b: each gets half of the time.
TEST(Mixture, SharesOfMirroredMethodsAreEqual) {
  const BlockSums a{1, 1, 9, 9}, b{9, 9, 1, 1}, bad{50, 50, 50, 50};
  const std::vector<BlockSums> errors{a, b, bad};
  const Shares shares = best_shares(errors);
  EXPECT_NEAR(share_of(shares[0]), 0.5, 1e-3);
  EXPECT_NEAR(share_of(shares[1]), 0.5, 1e-3);
  EXPECT_NEAR(share_of(shares[2]), 0, 1e-3);
  // 1 / (1/2 + 1/18) in each of four blocks.
  EXPECT_NEAR(mixed_error(shares, errors, errors), 4 * 1.8, 1e-2);
}

// At the optimum no share can be moved with gain.
TEST(Mixture, SharesAreOptimal) {
  std::mt19937_64 random(5);
  std::lognormal_distribution<double> values(0, 1.5);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<BlockSums> errors(4, BlockSums(30));
    for (auto& e : errors) {
      for (double& v : e) v = values(random);
    }
    const Shares best = best_shares(errors);
    const double error = mixed_error(best, errors, errors);
    for (std::size_t from = 0; from < 4; ++from) {
      for (std::size_t to = 0; to < 4; ++to) {
        Shares moved = best;
        const double step = std::min(0.01, moved[from][0]);
        for (double& s : moved[from]) s -= step;
        for (double& s : moved[to]) s += step;
        EXPECT_GT(mixed_error(moved, errors, errors), error * (1 - 1e-4));
      }
    }
  }
}

// Alone, a method that renders blocks by themselves spends on them in proportion to their noise.
TEST(Mixture, BlocksGetTheRootOfTheirVariance) {
  const BlockSums noise{1, 4, 25, 100};
  const std::vector<BlockSums> errors{noise};
  const std::vector<std::uint8_t> by_block{1};
  const Shares shares = best_shares(errors, by_block);
  const double mean = (1 + 2 + 5 + 10) / 4.0;
  for (std::size_t b = 0; b < noise.size(); ++b) {
    EXPECT_NEAR(shares[0][b], std::sqrt(noise[b]) / mean, 1e-6);
  }
  // 4 blocks' time: (sum of roots)^2 / 4.
  EXPECT_NEAR(mixed_error(shares, errors, errors), 18 * 18 / 4.0, 1e-6);
  EXPECT_NEAR(mixed_error(best_shares(errors), errors, errors), total(noise), 1e-9);
}

// One renders whole pictures, the other blocks: no time can be moved with gain.
TEST(Mixture, SharesOfBlocksAreOptimal) {
  std::mt19937_64 random(6);
  std::lognormal_distribution<double> values(0, 1);
  const std::vector<std::uint8_t> by_block{0, 1};
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<BlockSums> errors(2, BlockSums(12));
    for (auto& e : errors) {
      for (double& v : e) v = values(random);
    }
    const Shares best = best_shares(errors, by_block);
    EXPECT_NEAR(share_of(best[0]) + share_of(best[1]), 1, 1e-9);
    const double error = mixed_error(best, errors, errors);
    for (std::size_t b = 0; b < 12; ++b) {
      Shares moved = best;
      const double step = std::min(0.01, moved[1][b]);
      moved[1][b] -= step;
      moved[1][(b + 1) % 12] += step;
      EXPECT_GT(mixed_error(moved, errors, errors), error * (1 - 1e-3));
      moved = best;
      moved[1][b] -= step;
      for (double& s : moved[0]) s += step / 12;
      EXPECT_GT(mixed_error(moved, errors, errors), error * (1 - 1e-3));
    }
  }
}

TEST(Race, FindsTheLeastErrorForItsCost) {
  RaceLimits limits;
  limits.cost = 200;
  limits.budget = 2000;
  // Errors of a unit of cost: 4, 2, 9, 100.
  const std::vector<Noisy> methods{even(2, 1), even(0.5, 8), even(3, 1), even(10, 1)};
  std::map<std::size_t, int> winners;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Race race = raced(methods, seed, limits);
    ++winners[race.best()];
    EXPECT_LE(race.spent(), limits.cost + 8);
    EXPECT_LT(race.entrants()[3].trial.iterations(), 3U) << "a hopeless one leaves at once";
    // Found by its own estimates, or from one of each.
    const bool several = race.entrants()[1].trial.estimates() > 1;
    EXPECT_NEAR(race.entrants()[1].standing.error, 2, several ? 0.2 : 2);
  }
  EXPECT_EQ(winners[1], 20);
}

TEST(Race, TiesAreCheap) {
  RaceLimits limits;
  limits.cost = 40;
  limits.budget = 400;
  const std::vector<Noisy> methods(4, even(1));
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    EXPECT_LE(raced(methods, seed, limits).spent(), limits.cost + 1);
  }
}

TEST(Race, SeesWhatAMethodNeverFinds) {
  RaceLimits limits;
  limits.cost = 60;
  limits.budget = 600;
  Noisy blind = even(0.05);
  blind.mean = 0.5F;
  const Race race = raced({blind, even(0.3), even(0.6)}, 1, limits);
  EXPECT_EQ(race.best(), 1U);
}

TEST(Race, OneEntrantDoesNotRace) {
  Race race(1, width, height, {});
  EXPECT_FALSE(race.next());
  race.close();
  EXPECT_EQ(race.best(), 0U);
}

TEST(Race, WithoutNoiseTheFirstWins) {
  const Race race = raced({even(0), even(0), even(0)}, 1, {});
  EXPECT_EQ(race.best(), 0U);
  EXPECT_LE(race.spent(), 6);
}

TEST(Race, NoTimeForTheLater) {
  RaceLimits limits;
  limits.cost = 1;
  const Race race = raced({even(1, 2), even(0.1), even(0.1)}, 1, limits);
  EXPECT_EQ(race.best(), 0U);
  EXPECT_EQ(race.spent(), 2);
  EXPECT_EQ(race.entrants()[1].reason, "the race had no time left for it");
}

Noisy on_one_side(bool left) {
  return {[left](int x) { return (x < width / 2) == left ? 0.3 : 3; }, 1};
}

TEST(Plan, SharesRegions) {
  RaceLimits limits;
  limits.cost = 60;
  limits.budget = 6000;
  const Race race = raced({on_one_side(true), on_one_side(false), even(5)}, 3, limits);
  const Plan plan = make_plan(race, {.cost = 10});
  EXPECT_EQ(plan.methods(), 2);
  EXPECT_LT(plan.gain, 0.6);
  // The error of either alone is near 9/2; of both, each for half of the time, near 2 x .09.
  EXPECT_LT(plan.error, 1);
  const Plan alone = make_plan(race, {.cost = 10, .regions = false});
  EXPECT_EQ(alone.methods(), 1);
  EXPECT_NEAR(alone.error, 4.5, 0.9);
  // Weights of every block add up to 1.
  const BlockGrid grid(width, height);
  for (std::size_t b = 0; b < grid.blocks(); ++b) {
    EXPECT_NEAR(plan.weights[0][b] + plan.weights[1][b], 1, 1e-5);
  }
}

TEST(Plan, EqualMethodsDoNotShare) {
  RaceLimits limits;
  limits.cost = 60;
  limits.budget = 6000;
  int mixed = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Race race = raced({even(1), even(1), even(1)}, seed, limits);
    mixed += make_plan(race, {.cost = 10}).methods() > 1;
  }
  EXPECT_EQ(mixed, 0);
}

TEST(Plan, CombinesByWeights) {
  Plan plan;
  plan.iterations = {2, 0, 1};
  const BlockGrid grid(width, height);
  plan.counts = {std::vector<int>(grid.blocks(), 2), {}, std::vector<int>(grid.blocks(), 1)};
  plan.weights = {
      std::vector<float>(grid.blocks(), 0.25F), {}, std::vector<float>(grid.blocks(), 0.75F)};
  Image a(width, height), c(width, height), out(width, height);
  for (Rgb& p : a.pixels) p = Rgb(8, 8, 8);  // the sum of two
  for (Rgb& p : c.pixels) p = Rgb(12, 12, 12);
  combine(plan, grid, {a, Image(), c}, out);
  EXPECT_FLOAT_EQ(out.at(width - 1, height - 1).x, 10);
}

// The left half is ten times as noisy, and gets the more iterations.
TEST(Plan, NoisyBlocksGetMoreIterations) {
  RaceLimits limits;
  limits.cost = 60;
  limits.budget = 6000;
  const Noisy one_side{[](int x) { return x < width / 2 ? 10.0 : 1.0; }, 1};
  const Race race = raced({one_side, even(9)}, 3, limits);
  const Plan plan = make_plan(race, {.cost = 40, .regions = false, .by_block = {1, 1}});
  ASSERT_EQ(plan.methods(), 1);
  ASSERT_TRUE(plan.is_adaptive());
  const std::vector<int>& counts = plan.counts[0];
  const BlockGrid grid(width, height);
  // Roots of 100 and 1 about their mean, but for smoothing: 10 to 1.
  EXPECT_GT(counts[grid.block_of(1, 1)], 60);
  EXPECT_LT(counts[grid.block_of(width - 1, 1)], 20);
  // (10 + 1)^2 / 4 over (100 + 1) / 2.
  EXPECT_NEAR(plan.gain, 0.6, 0.1);

  // The parts of all iterations are the blocks that they are counted for.
  std::vector<int> found(grid.pixels(), 0);
  std::size_t pixels = 0;
  std::vector<std::uint64_t> drawn(grid.blocks());
  for (std::size_t b = 0; b < drawn.size(); ++b) drawn[b] = 3 * b % 7;
  for (int i = 0; i < plan.iterations[0]; ++i) {
    for (const Tile& t : parts_of(plan, grid, 0, i, drawn, pixels)) {
      for (int p = 0; p < t.pixels(); ++p) {
        // Each pixel's samples follow one another.
        const std::size_t block = grid.block_of(t.pixel(p).x, t.pixel(p).y);
        ASSERT_EQ(t.samples_before, drawn[block] + std::uint64_t(i));
        ++found[std::size_t(t.pixel(p).y * width + t.pixel(p).x)];
      }
    }
  }
  std::size_t all = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      ASSERT_EQ(found[std::size_t(y * width + x)], counts[grid.block_of(x, y)]);
      all += std::size_t(counts[grid.block_of(x, y)]);
    }
  }
  EXPECT_EQ(pixels, all);
  EXPECT_FALSE(make_plan(race, {.cost = 40}).is_adaptive());
  // Too long for many estimates in the budget.
  const Race slow = raced({one_side, even(9)}, 3, {.cost = 60, .budget = 100});
  EXPECT_FALSE(make_plan(slow, {.cost = 1, .by_block = {1, 1}}).is_adaptive());
}

// What a biased method saves in noise is weighed against what stays.
TEST(Race, BiasCountsForTheRestOfTheBudget) {
  Noisy shifted = even(0.3);
  shifted.mean = 0.9F;
  const auto race_of = [&](double budget) {
    RaceLimits limits;
    limits.cost = 60;
    limits.budget = budget;
    Race race(3, width, height, limits, {0, 0, 1});
    Pictures pictures(5);
    const std::vector<Noisy> methods{even(1), even(1.5), shifted};
    while (const auto k = race.next()) race.finished(*k, pictures(methods[*k]), methods[*k].cost);
    race.close();
    return race;
  };
  // Squared errors: .09 / 80 + .01 against 1 / 80, and .09 / 2000 + .01 against 1 / 2000.
  const Race brief = race_of(80), thorough = race_of(2000);
  EXPECT_EQ(brief.best(), 2U);
  EXPECT_EQ(thorough.best(), 0U);
  EXPECT_NEAR(std::sqrt(brief.entrants()[2].standing.bias), 0.1, 0.02);
  const Plan plan = make_plan(brief, {.cost = 10});
  EXPECT_EQ(plan.methods(), 1) << "a biased method shares the picture with no other";
}

TEST(Race, GoesOnFromItsBytes) {
  RaceLimits limits;
  limits.cost = 50;
  limits.budget = 500;
  const std::vector<Noisy> methods{even(1), even(1.02), even(0.7, 2)};
  const Race whole = raced(methods, 7, limits);
  Race before(methods.size(), width, height, limits);
  Pictures pictures(7);
  for (int i = 0; i < 5; ++i) {
    const auto k = before.next();
    ASSERT_TRUE(k);
    before.finished(*k, pictures(methods[*k]), methods[*k].cost);
  }
  ByteWriter out;
  before.save(out);
  Race after(methods.size(), width, height, limits);
  ByteReader in(out.bytes());
  after.load(in);
  while (const auto k = after.next()) after.finished(*k, pictures(methods[*k]), methods[*k].cost);
  after.close();
  ByteWriter a, b;
  whole.save(a);
  after.save(b);
  EXPECT_TRUE(a.bytes() == b.bytes());
}

}  // namespace
}  // namespace lacuna
