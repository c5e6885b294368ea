#include "renderer/path/training_samples.h"

#include <gtest/gtest.h>

#include <set>

#include "renderer/path/learning_rounds.h"

namespace lacuna {
namespace {

TEST(TrainingSamples, AreSortedByCellInTheOrderOfTheirParts) {
  const auto sample = [](std::uint32_t cell, float light) {
    return TrainingSample{.cell = {1, cell}, .x = {0, 0, 0}, .n = {0, 0, 1}, .reflected = light};
  };
  const std::vector<TrainingSamples::Part> parts{
      {sample(2, 1), sample(0, 2)}, {}, {sample(2, 3), sample(GuidingCell::none, 4), sample(2, 5)}};
  const TrainingSamples samples(parts, 3, ThreadPool(2));
  EXPECT_EQ(samples.size(), 5U);
  EXPECT_TRUE(samples.of(1).empty());
  ASSERT_EQ(samples.of(2).size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(samples.of(2)[i].reflected, float(2 * i + 1));
  EXPECT_EQ(samples.of(0)[0].reflected, 2);
  EXPECT_EQ(samples.all().back().reflected, 4);
}

TEST(LearningPass, TheFirstIterationRendersEachBlockOnce) {
  for (const auto& [x, y] : {std::pair{0, 0}, {8, 0}, {0, 8}, {1000, 720}, {3832, 2152}}) {
    int rendered = 0;
    for (LearningPass p = LearningPass::begin(true); p.first < LearningPass::parts; p = p.next()) {
      rendered += p.renders(x, y) ? 1 : 0;
    }
    EXPECT_EQ(rendered, 1) << x << ' ' << y;
  }
  EXPECT_EQ(LearningPass::begin(false).next().first, LearningPass::parts);
}

TEST(LearningPass, PartsAreAlike) {
  const LearningPass pass{5, 6};
  int blocks = 0;
  for (int y = 0; y < 1024; y += 8) {
    for (int x = 0; x < 1024; x += 8) blocks += pass.renders(x, y) ? 1 : 0;
  }
  // Binomial: 16384 blocks, 1/64; five standard deviations.
  EXPECT_NEAR(blocks, 256, 5 * 16);
}

TEST(LearningRounds, AreAsLongAsAllBefore) {
  LearningRounds rounds;
  std::vector<double> ends;
  double done = 0;
  for (LearningPass p = LearningPass::begin(true); p.first < LearningPass::parts; p = p.next()) {
    done += p.share();
    if (rounds.add(p.share())) ends.push_back(done);
  }
  for (int i = 0; i < 7; ++i) {
    done += 1;
    if (rounds.add(1)) ends.push_back(done);
  }
  const std::vector<double> expected{1 / 64., 1 / 32., 1 / 16., 1 / 8., 1 / 4., 1 / 2., 1, 2, 4, 8};
  EXPECT_EQ(ends, expected);
}

}  // namespace
}  // namespace lacuna
