// The probability of a guide that is learned from samples of a known mixture.

#include "renderer/path/learned_probability.h"

#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "renderer/settings/guide_settings.h"

namespace lacuna {
namespace {

/// Light on a line of two halves: the guide has the density 1.8 on the first and 0.2 on the second,
/// the BSDF 1 on both. `first`: the share of the light in the first half.
struct TwoHalves {
  double first;
  double scale = 1;

  /// The probability that minimises the divergence: c 1.8 + (1 - c) is 2 `first` there.
  double best() const { return (2 * first - 1) / 0.8; }

  TrainingSamples::Part samples(const LearnedProbability& now, int n, std::uint64_t seed) const {
    Rng rng(seed, 0, 0, Rng::Purpose::test);
    TrainingSamples::Part part;
    const double c = double(now[0]);
    for (int i = 0; i < n; ++i) {
      const double on_first = (c * 1.8 + 1 - c) / 2;
      const bool is_first = rng.next_choice() < on_first;
      const double p = is_first ? 2 * on_first : 2 * (1 - on_first);
      const double light = scale * (is_first ? 2 * first : 2 * (1 - first));
      part.push_back({.cell = {float(c), 0},
                      .x = {0, 0, 0},
                      .n = {0, 0, 1},
                      .pdf = float(p),
                      .bsdf_pdf = 1,
                      .reflected = float(light / p)});
    }
    return part;
  }
};

double learned(const TwoHalves& light) {
  const ThreadPool pool(1);
  LearnedProbability probability(1);
  double sum = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const TrainingSamples::Part part = light.samples(probability, 2000, i);
    probability.update(TrainingSamples(std::span(&part, 1), 1, pool), pool);
    if (i >= 20) sum += double(probability[0]) / 40;
  }
  return sum;
}

TEST(LearnedProbability, IsThatOfTheLeastDivergence) {
  for (const double first : {0.6, 0.7, 0.8}) {
    const TwoHalves light{first};
    EXPECT_NEAR(learned(light), light.best(), 0.05) << first;
  }
  EXPECT_LT(learned({0.3}), 0.1);
  EXPECT_GT(learned({0.95}), 0.85);
}

// However long the guide was useless, c is found again within some thousand samples.
TEST(LearnedProbability, FollowsAChangeOfTheLight) {
  const ThreadPool pool(1);
  LearnedProbability probability(1);
  const auto learn = [&](const TwoHalves& light, int passes) {
    for (int i = 0; i < passes; ++i) {
      const auto part = light.samples(probability, 1000, static_cast<std::uint64_t>(i));
      probability.update(TrainingSamples(std::span(&part, 1), 1, pool), pool);
    }
  };
  learn({0.1}, 100);
  EXPECT_LT(probability[0], 0.01);
  learn({0.95}, 3);
  EXPECT_GT(probability[0], 0.7);
}

TEST(LearnedProbability, DoesNotDependOnTheScaleOfLight) {
  const double one = learned({0.7, 1});
  for (const double scale : {1e-15, 1e15}) EXPECT_NEAR(learned({0.7, scale}), one, 1e-3) << scale;
}

TEST(LearnedProbability, LearnsNothingFromOtherSamples) {
  const ThreadPool pool(1);
  LearnedProbability probability(2);
  const float before = probability[1];
  TrainingSamples::Part part;
  for (const TrainingSample& s :
       {TrainingSample{.cell = {0, 1}, .x = {0, 0, 0}, .n = {0, 0, 1}, .pdf = 1, .reflected = 1},
        TrainingSample{.cell = {0.5F, 1}, .x = {0, 0, 0}, .n = {0, 0, 1}, .reflected = 1},
        TrainingSample{.cell = {1, 1}, .x = {0, 0, 0}, .n = {0, 0, 1}, .pdf = 1, .reflected = 1},
        TrainingSample{.cell = {0.5F, GuidingCell::none},
        .x = {0, 0, 0},
        .n = {0, 0, 1},
        .pdf = 1,
        .reflected = 1}}) {
    part.push_back(s);
  }
  probability.update(TrainingSamples(std::span(&part, 1), 2, pool), pool);
  EXPECT_EQ(probability[1], before);
}

TEST(LearnedProbability, OfADividedCellIsThatOfItsOrigin) {
  const ThreadPool pool(1);
  LearnedProbability probability(1);
  const TrainingSamples::Part part = TwoHalves{0.8}.samples(probability, 500, 1);
  probability.update(TrainingSamples(std::span(&part, 1), 1, pool), pool);
  probability.divide(std::array{0U});
  ASSERT_EQ(probability.size(), 2U);
  EXPECT_EQ(probability[1], probability[0]);

  ByteWriter saved;
  probability.save(saved);
  LearnedProbability again;
  ByteReader in(saved.bytes());
  again.load(in, 2);
  EXPECT_EQ(again[1], probability[0]);
  ByteReader other(saved.bytes());
  EXPECT_THROW(again.load(other, 3), std::runtime_error);
}

}  // namespace
}  // namespace lacuna
