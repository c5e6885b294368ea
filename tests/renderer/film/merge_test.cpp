// Films of parts of the iterations against one film of them all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/storage/bytes.h"
#include "renderer/core/rng.h"
#include "renderer/film/film.h"
#include "tests/double_double.h"

namespace lacuna {
namespace {

constexpr int columns = 6, lines = 3;  // rows that are no multiple of what is added at once

/// Values of both signs over 12 decades: sums in double depend on their order.
Image wide_estimate(std::uint64_t iteration) {
  Image image(columns, lines);
  Rng rng(5, iteration, 0, Rng::Purpose::test);
  for (Rgb& p : image.pixels) {
    for (int c = 0; c < 3; ++c) {
      p[c] = std::pow(10.0F, 12 * rng.next() - 6) * (rng.next() < 0.3F ? -1.0F : 1.0F);
    }
  }
  return image;
}

constexpr std::uint64_t iterations = 101;

/// Of the pairs of iterations that are `k` modulo `n`.
Film part(std::uint64_t k, std::uint64_t n) {
  Film film(columns, lines);
  for (std::uint64_t i = 0; i < iterations; ++i) {
    if (i / 2 % n == k) film.add(i, wide_estimate(i));
  }
  return film;
}

TEST(FilmMerge, IsTheFilmOfAllIterationsWhateverTheNumberAndOrderOfParts) {
  const Film whole = part(0, 1);
  std::minstd_rand random(3);
  for (const std::uint64_t n : {1, 2, 3, 8}) {
    std::vector<Film> parts;
    for (std::uint64_t k = 0; k < n; ++k) parts.push_back(part(k, n));
    for (int order = 0; order < 10; ++order) {
      std::shuffle(parts.begin(), parts.end(), random);
      Film merged(columns, lines);
      for (const Film& p : parts) merged.merge(p);
      EXPECT_TRUE(merged.exact());
      EXPECT_EQ(merged.iterations(), iterations);
      EXPECT_EQ(merged.half_iterations(0), 51U);
      EXPECT_EQ(merged.mean(), whole.mean()) << n;
      EXPECT_EQ(merged.half_mean(0), whole.half_mean(0)) << n;
      EXPECT_EQ(merged.half_mean(1), whole.half_mean(1)) << n;
      EXPECT_EQ(merged.variance_of_mean(), whole.variance_of_mean()) << n;
    }
  }
}

TEST(FilmMerge, TheMeanIsTheExactOne) {
  const Film whole = part(0, 1);
  const std::vector<double> mean = whole.mean();
  for (std::size_t v = 0; v < mean.size(); ++v) {
    test::DoubleDouble sum;
    for (std::uint64_t i = 0; i < iterations; ++i) {
      sum = sum + test::DoubleDouble{double(wide_estimate(i).pixels[v / 3][int(v % 3)])};
    }
    EXPECT_EQ(mean[v], sum.high / double(iterations));
  }
}

TEST(FilmMerge, SaysWhereABitWasLost) {
  Film film(1, 1);
  Image image(1, 1);
  image.pixels[0] = Rgb(1, 1, 1);
  film.add(0, image);
  image.pixels[0] = Rgb(1, 0x1p-57F, 1);
  film.add(2, image);
  EXPECT_TRUE(film.exact());
  Film other(1, 1);
  image.pixels[0] = Rgb(1, 0x1p-120F, 1);
  other.add(4, image);
  EXPECT_TRUE(other.exact());
  film.merge(other);
  EXPECT_FALSE(film.exact());
  ByteWriter out;
  film.save(out);
  ByteReader in(out.bytes());
  Film again(1, 1);
  again.load(in);
  EXPECT_FALSE(again.exact());
}

TEST(FilmMerge, KeepsTheLargestSquaredErrorsOfAll) {
  constexpr std::uint64_t n = 4;
  Film merged(columns, lines);
  std::vector<double> all;
  for (std::uint64_t k = 0; k < n; ++k) {
    const Film p = part(k, n);
    for (const double v : p.squared_errors().largest()) all.push_back(v);
    merged.merge(p);
  }
  std::sort(all.begin(), all.end());
  EXPECT_EQ(merged.squared_errors().count(), all.size());
  EXPECT_EQ(merged.squared_errors().largest(), all);
  EXPECT_THROW(merged.merge(Film(columns, lines + 1)), std::invalid_argument);
}

TEST(FilmMerge, EqualIterationsHaveNoVariance) {
  Film film(1, 1);
  Image image(1, 1);
  image.pixels[0] = Rgb(0.1F, 1e30F, 1e-30F);
  for (std::uint64_t i = 0; i < 1000; ++i) film.add(i, image);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(film.mean()[c], double(image.pixels[0][int(c)]));
    EXPECT_EQ(film.variance_of_mean()[c], 0);
  }
}

}  // namespace
}  // namespace lacuna
