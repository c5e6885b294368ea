// A million iterations of everything between a trillionth and a trillion.
#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "renderer/film/film.h"
#include "tests/double_double.h"

namespace lacuna {
namespace {

TEST(Accumulation, DoubleDoubleKeepsWhatDoubleLoses) {
  test::DoubleDouble sum{1e16};
  for (int i = 0; i < 1000; ++i) sum = sum + test::DoubleDouble{0.125};
  EXPECT_EQ((sum + test::DoubleDouble{-1e16}).value(), 125);
  const test::DoubleDouble square =
      test::DoubleDouble::sum(1, 0x1p-60) * test::DoubleDouble::sum(1, 0x1p-60);
  EXPECT_EQ((square + test::DoubleDouble{-1}).value(), 0x1p-59);
  const test::DoubleDouble third = test::DoubleDouble{1} / 3;
  EXPECT_LT(std::abs((third * test::DoubleDouble{3} + test::DoubleDouble{-1}).value()), 0x1p-102);
}

TEST(Accumulation, AMillionIterationsAreWithinTheBoundOfTheirRounding) {
  constexpr std::size_t n = 1'000'000;
  // Log-uniform over 24 decades; the same about a level far above its noise, where squares cancel;
  // and of both signs.
  Film film(1, 1);
  std::array<std::vector<double>, 3> values;
  Image image(1, 1);
  for (std::size_t i = 0; i < n; ++i) {
    Rng rng(7, i, 0, Rng::Purpose::test);
    const float x = std::pow(10.0F, 24 * rng.next() - 12);
    const float y = 1000 + rng.next();
    const float z = std::pow(10.0F, 24 * rng.next() - 12) * (rng.next() < 0.5F ? 1.0F : -1.0F);
    image.pixels[0] = Rgb(x, y, z);
    for (int c = 0; c < 3; ++c) values[std::size_t(c)].push_back(double(image.pixels[0][c]));
    film.add(i, image);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    SCOPED_TRACE(c);
    const test::ExactMoments exact = test::exact_moments(values[c]);
    EXPECT_NEAR(film.mean()[c], exact.mean, exact.mean_bound);
    EXPECT_NEAR(film.variance_of_mean()[c], exact.variance_of_mean, exact.variance_bound);
    EXPECT_LT(exact.mean_bound, 2e-10 * std::abs(exact.mean) + (c == 2 ? 10 : 0));
  }
}

TEST(Accumulation, OneIterationIsItself) {
  Film film(1, 1);
  Image image(1, 1);
  image.pixels[0] = Rgb(1e-12F, 1e12F, 0);
  film.add(0, image);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(film.mean()[c], double(image.pixels[0][int(c)]));
    EXPECT_EQ(film.variance_of_mean()[c], 0);
  }
}

}  // namespace
}  // namespace lacuna
