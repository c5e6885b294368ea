// The tests of significance against published values and their own distribution.

#include "tests/statistics.h"

#include <gtest/gtest.h>

#include "renderer/core/rng.h"

namespace lacuna::statistics {
namespace {

TEST(Statistics, ChiSquareInClosedForm) {
  EXPECT_EQ(chi_square_beyond(0, 5), 1);
  // Of 2 degrees of freedom, 1 and 6: exp(-x); erfc(sqrt x); exp(-x) (1 + x + x^2 / 2).
  for (const double x : {1e-3, 0.5, 1.0, 3.0, 20.0, 200.0}) {
    EXPECT_NEAR(chi_square_beyond(2 * x, 2) / std::exp(-x), 1, 1e-12);
    EXPECT_NEAR(chi_square_beyond(2 * x, 1) / std::erfc(std::sqrt(x)), 1, 1e-12);
    EXPECT_NEAR(chi_square_beyond(2 * x, 6) / (std::exp(-x) * (1 + x + x * x / 2)), 1, 1e-12);
  }
  EXPECT_THROW(chi_square_beyond(1, 0), std::domain_error);
  EXPECT_THROW(chi_square_beyond(std::nan(""), 2), std::domain_error);
}

/// Abramowitz and Stegun, tables 26.8 and 26.10: points that are exceeded with the given
/// probability.
TEST(Statistics, Tables) {
  EXPECT_NEAR(chi_square_beyond(3.841459, 1), 0.05, 1e-7);
  EXPECT_NEAR(chi_square_beyond(18.30704, 10), 0.05, 1e-6);
  EXPECT_NEAR(chi_square_beyond(135.807, 100), 0.01, 1e-6);
  EXPECT_NEAR(student_beyond(12.706205, 1), 0.05, 1e-8);
  EXPECT_NEAR(student_beyond(2.228139, 10), 0.05, 1e-7);
  EXPECT_NEAR(student_beyond(3.169273, 10), 0.01, 1e-7);
  EXPECT_NEAR(two_sided_p(1.959964), 0.05, 1e-7);
  EXPECT_NEAR(upper_p(1.644854), 0.05, 1e-7);
  // Student's distribution becomes the normal one.
  EXPECT_NEAR(student_beyond(2, 1e7), two_sided_p(2), 1e-7);
}

TEST(Statistics, Sidak) {
  EXPECT_DOUBLE_EQ(sidak(0.05, 1), 0.05);
  EXPECT_NEAR(1 - std::pow(1 - sidak(0.05, 20), 20), 0.05, 1e-12);
}

TEST(Statistics, Moments) {
  Moments m;
  for (const double x : {1.0, 2.0, 4.0, 9.0}) m.add(1e9 + x);
  EXPECT_EQ(m.count(), 4U);
  EXPECT_DOUBLE_EQ(m.mean(), 1e9 + 4);
  EXPECT_NEAR(m.variance(), 38.0 / 3, 1e-6);
  EXPECT_NEAR(m.standard_error(), std::sqrt(38.0 / 12), 1e-6);
}

/// A constant has no noise: it is right or it is wrong.
TEST(Statistics, Constants) {
  Moments ones;
  for (int i = 0; i < 10; ++i) ones.add(1);
  EXPECT_EQ(z_test(ones, 1), 1);
  EXPECT_EQ(z_test(ones, 1.001), 0);
  EXPECT_EQ(t_test(ones, 1), 1);
  EXPECT_EQ(t_test(ones, 1.001), 0);
  EXPECT_EQ(t_test(ones, ones), 1);
  EXPECT_EQ(z_test_at_most(ones, 0.999), 0);
  EXPECT_EQ(z_test_at_most(ones, 1.001), 1);
}

TEST(Statistics, ChiSquarePoolsSmallCells) {
  const std::vector<double> expected{50, 1, 1, 1, 1, 1, 45};
  const std::vector<double> observed{50, 5, 0, 0, 0, 0, 45};
  const ChiSquare r = chi_square_test(observed, expected);
  EXPECT_EQ(r.degrees_of_freedom, 2);
  EXPECT_EQ(r.statistic, 0);
  EXPECT_EQ(r.p, 1);
}

TEST(Statistics, ChiSquareRefusesTheImpossible) {
  const std::vector<double> expected{50, 0, 50};
  EXPECT_EQ(chi_square_test(std::vector<double>{50, 1, 49}, expected).p, 0);
  EXPECT_GT(chi_square_test(std::vector<double>{50, 0, 50}, expected).p, 0.9);
  EXPECT_THROW(chi_square_test(std::vector<double>{1}, expected), std::invalid_argument);
  EXPECT_THROW(chi_square_test(std::vector<double>{1}, std::vector<double>{std::nan("")}),
               std::invalid_argument);
}

/// p-values of right hypotheses are uniform: tested by the same test one level up.
TEST(Statistics, BinomialTails) {
  EXPECT_NEAR(binomial_at_least(8, 10, 0.5), 56.0 / 1024, 1e-12);
  EXPECT_NEAR(binomial_at_least(1, 3, 0.2), 1 - 0.512, 1e-12);
  EXPECT_NEAR(binomial_at_least(0, 24, 0.25), 1, 1e-12);
  EXPECT_EQ(binomial_at_least(25, 24, 0.25), 0);
}

TEST(Statistics, PValuesAreUniform) {
  Rng random(1, 0, 0, Rng::Purpose::test);
  constexpr int bins = 10, repeats = 2000;
  std::vector<double> chi(bins), z(bins), t(bins);
  const std::vector<double> expected(bins, double(repeats) / bins);
  const auto count = [](std::vector<double>& histogram, double p) {
    ++histogram[std::min(static_cast<std::size_t>(p * bins), std::size_t{bins - 1})];
  };
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::vector<double> cells(20);
    for (int i = 0; i < 2000; ++i) ++cells[static_cast<std::size_t>(random.next() * 20)];
    count(chi, chi_square_test(cells, std::vector<double>(20, 100)).p);
    Moments many, few;
    for (int i = 0; i < 200; ++i) many.add(random.next());
    for (int i = 0; i < 6; ++i) {
      // Normal numbers (Box and Muller 1958).
      const double r = std::sqrt(-2 * std::log(1 - double(random.next())));
      few.add(3 + r * std::cos(2 * std::numbers::pi * double(random.next())));
    }
    count(z, z_test(many, 0.5 - 0x1p-25));
    count(t, t_test(few, 3));
  }
  for (const auto& histogram : {chi, z, t}) {
    const ChiSquare r = chi_square_test(histogram, expected);
    EXPECT_GT(r.p, sidak(1e-3, 3)) << r.message;
  }
}

}  // namespace
}  // namespace lacuna::statistics
