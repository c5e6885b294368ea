// How candidates are ranked: errors from halves, bias against the best unbiased picture, and who
// stays.

#include "jobs/run/ranking.h"

#include <gtest/gtest.h>

#include <random>

namespace lacuna {
namespace {

constexpr int width = 64, height = 48;

/// `n` iterations of a picture of `mean` on the left and a tenth of it on the right, with normal
/// noise of `deviation` times the value.
Film picture(int n, float mean, float deviation, std::uint64_t seed) {
  std::mt19937_64 numbers(seed);
  std::normal_distribution<float> normal;
  Film film(width, height);
  for (int i = 0; i < n; ++i) {
    Image image(width, height);
    for (int p = 0; p < width * height; ++p) {
      const float value = p % width < width / 2 ? mean : mean / 10;
      const auto noisy = [&] { return value * (1 + deviation * normal(numbers)); };
      image.pixels[std::size_t(p)] = Rgb(noisy(), noisy(), noisy());
    }
    film.add(std::uint64_t(i), image);
  }
  return film;
}

TEST(Ranking, NoiseIsTheSquaredErrorOfTheMean) {
  const Film film = picture(32, 2, 0.5F, 1);
  const std::vector<CandidatePicture> one{{&film, false}};
  // The mean of both sides of (value deviation)^2 / 32, absolute and over value^2 + 0.01.
  const double bright = 1, dark = 0.1 * 0.1;
  const double mse = (bright + dark) / 2 / 32;
  const double relative = (bright / 4.01 + dark / 0.05) / 2 / 32;
  EXPECT_NEAR(picture_errors(one, RankingMetric::mse)[0]->noise, mse, 0.06 * mse);
  EXPECT_NEAR(picture_errors(one, RankingMetric::relmse)[0]->noise, relative, 0.06 * relative);
}

// Relative to what other pictures show there, not to itself.
TEST(Ranking, AnOutlierDoesNotHideItself) {
  const Film plain = picture(8, 1, 0.1F, 1), other = picture(8, 1, 0.1F, 2);
  Film outlier = picture(7, 1, 0.1F, 3);
  Image bright(width, height);
  bright.pixels[0] = Rgb(8e4F, 8e4F, 8e4F);
  outlier.add(7, bright);
  const auto errors = picture_errors(
      std::vector<CandidatePicture>{{&plain, false}, {&outlier, false}, {&other, false}},
      RankingMetric::relmse);
  // (1e4)^2 in one of 3072 pixels, over about (1e4 / 256 / 3 + 1)^2.
  EXPECT_GT(errors[1]->noise, 1e8 / 3072 / (14 * 14 + 1) / 2);
}

TEST(Ranking, BiasIsTheDifferenceToTheBestUnbiasedPicture) {
  const Film right = picture(16, 1, 0.3F, 1), noisy = picture(4, 1, 1, 2);
  const Film darker = picture(16, 0.9F, 0.3F, 3), same = picture(16, 1, 0.3F, 4);
  const auto errors = picture_errors(
      std::vector<CandidatePicture>{
          {&noisy, false}, {&darker, true}, {&right, false}, {&same, true}},
      RankingMetric::mse);
  const double bias = 0.01 * (1 + 0.01) / 2;
  EXPECT_NEAR(errors[1]->bias, bias, 0.1 * bias);
  EXPECT_LT(errors[3]->bias, 0.1 * bias);
  EXPECT_EQ(errors[0]->bias, 0);
  EXPECT_EQ(errors[2]->bias, 0);
}

TEST(Ranking, WhatShowsNothingHasNoError) {
  const Film one = picture(1, 1, 0.3F, 1), black = picture(8, 0, 0, 2), right = picture(8, 1, 1, 3);
  const auto errors =
      picture_errors(std::vector<CandidatePicture>{{&one, false}, {&black, false}, {&right, false}},
                     RankingMetric::relmse);
  EXPECT_FALSE(errors[0]) << "one half has no iteration, and only one other picture shows anything";
  EXPECT_FALSE(errors[1]) << "another picture is not black";
  EXPECT_TRUE(errors[2]);
  const auto dark = picture_errors(std::vector<CandidatePicture>{{&black, false}, {&black, false}},
                                   RankingMetric::relmse);
  EXPECT_EQ(dark[0]->noise, 0);
}

TEST(Ranking, OfOneIterationTheDistancesToOthersTellTheNoise) {
  const Film a = picture(1, 1, 0.5F, 1), b = picture(1, 1, 1, 2), c = picture(1, 1, 2, 3);
  const std::vector<CandidatePicture> three{{&a, false}, {&b, false}, {&c, false}};
  const auto errors = picture_errors(three, RankingMetric::mse);
  const double unit = (1 + 0.01) / 2;
  EXPECT_NEAR(errors[0]->noise, 0.25 * unit, 0.1 * unit);
  EXPECT_NEAR(errors[1]->noise, unit, 0.1 * unit);
  EXPECT_NEAR(errors[2]->noise, 4 * unit, 0.3 * unit);
}

TEST(Ranking, TheBetterHalfStays) {
  using Errors = std::vector<std::optional<double>>;
  using Kept = std::vector<std::size_t>;
  const auto kept = [](const Errors& errors, const std::vector<bool>& biased, bool first = false) {
    return better_half(errors, biased, first);
  };
  EXPECT_EQ(kept({5, 1, 3, 2, 4}, std::vector<bool>(5)), (Kept{1, 2, 3}));
  EXPECT_EQ(kept({2, 1}, std::vector<bool>(2)), Kept{1});
  EXPECT_EQ(kept({2, 2}, std::vector<bool>(2)), Kept{0}) << "the first of equals";
  EXPECT_EQ(kept({{}, 9, {}, {}}, std::vector<bool>(4)), (Kept{0, 1}));
  // Bias is known by a difference to an unbiased picture.
  EXPECT_EQ(kept({1, 2, 3, 4}, {true, true, false, false}), (Kept{0, 2}));
  EXPECT_EQ(kept({1, 2}, {true, false}), Kept{0});
  // The default stays in doubt.
  EXPECT_EQ(kept({9, 1, 3, 2, 4}, std::vector<bool>(5), true), (Kept{0, 1, 3}));
  EXPECT_EQ(kept({1.9, 1}, std::vector<bool>(2), true), Kept{0});
  EXPECT_EQ(kept({2.1, 1}, std::vector<bool>(2), true), Kept{1});
  EXPECT_EQ(kept({9, 1, 2, 3}, {true, true, true, false}, true), (Kept{0, 3}));
}

}  // namespace
}  // namespace lacuna
