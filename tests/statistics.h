#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "jobs/sweep/distributions.h"

namespace lacuna::statistics {

// Tests of significance for samplers and estimators. A test yields a p-value: the probability, if
// all is right, of a result at least as far off. A suite that makes n tests and accepts one false
// alarm in 1 / level runs rejects where p < sidak(level, n).

/// Level of each of `n` independent tests such that all pass together with probability 1 - level
/// (Sidak 1967).
inline double sidak(double level, std::size_t n) {
  return -std::expm1(std::log1p(-level) / static_cast<double>(n));
}

/// Probability that a standard normal variable is further from 0 than `z`.
inline double two_sided_p(double z) { return std::erfc(std::abs(z) / std::numbers::sqrt2); }
/// Probability that a standard normal variable exceeds `z`.
inline double upper_p(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }
/// Probability that of `n` independent trials, each a success with probability `p` in (0, 1), at
/// least `k` are successes.
inline double binomial_at_least(int k, int n, double p) {
  double sum = 0;
  for (int i = std::max(k, 0); i <= n; ++i) {
    sum += std::exp(std::lgamma(n + 1.0) - std::lgamma(i + 1.0) - std::lgamma(n - i + 1.0) +
                    i * std::log(p) + (n - i) * std::log1p(-p));
  }
  return std::min(sum, 1.0);
}

/// Mean and variance of a stream of numbers (Welford 1962).
class Moments {
 public:
  void add(double x) {
    ++n_;
    const double d = x - mean_;
    mean_ += d / static_cast<double>(n_);
    m2_ += d * (x - mean_);
  }
  std::uint64_t count() const { return n_; }
  double mean() const { return mean_; }
  /// Unbiased; of at least two numbers.
  double variance() const { return m2_ / static_cast<double>(n_ - 1); }
  double standard_error() const { return std::sqrt(variance() / static_cast<double>(n_)); }

 private:
  std::uint64_t n_ = 0;
  double mean_ = 0, m2_ = 0;
};

/// z of `difference`; where nothing varies, equal is equal and anything else is infinitely far off.
inline double z_score(double difference, double standard_error) {
  if (standard_error > 0) return difference / standard_error;
  return difference == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), difference);
}

/// Is the mean of the sampled quantity `expected`? Normal approximation: for many samples.
inline double z_test(const Moments& m, double expected) {
  return two_sided_p(z_score(m.mean() - expected, m.standard_error()));
}
/// Is it at most `bound`? One-sided.
inline double z_test_at_most(const Moments& m, double bound) {
  return upper_p(z_score(m.mean() - bound, m.standard_error()));
}
/// Do two sampled quantities have the same mean?
inline double z_test(const Moments& a, const Moments& b) {
  return two_sided_p(
      z_score(a.mean() - b.mean(), std::hypot(a.standard_error(), b.standard_error())));
}
/// Is the mean of a few normal samples `expected`? Student's test.
inline double t_test(const Moments& m, double expected) {
  const double t = z_score(m.mean() - expected, m.standard_error());
  return std::isfinite(t) ? student_beyond(t, static_cast<double>(m.count() - 1)) : 0;
}
/// Is the mean of a few normal samples at least `bound`? One-sided: what shows that it is below.
inline double t_test_at_least(const Moments& m, double bound) {
  const double t = z_score(m.mean() - bound, m.standard_error());
  if (!std::isfinite(t)) return t > 0 ? 1 : 0;
  const double beyond = student_beyond(t, static_cast<double>(m.count() - 1)) / 2;
  return t > 0 ? 1 - beyond : beyond;
}
/// Do a few normal samples of each kind have the same mean? Welch's test.
inline double t_test(const Moments& a, const Moments& b) {
  const double va = a.standard_error() * a.standard_error();
  const double vb = b.standard_error() * b.standard_error();
  const double t = z_score(a.mean() - b.mean(), std::sqrt(va + vb));
  if (!std::isfinite(t)) return 0;
  if (va + vb == 0) return 1;
  const double dof =
      (va + vb) * (va + vb) /
      (va * va / static_cast<double>(a.count() - 1) + vb * vb / static_cast<double>(b.count() - 1));
  return student_beyond(t, dof);
}

struct ChiSquare {
  double statistic = 0;
  double degrees_of_freedom = 0;
  double p = 1;
  std::string message;  ///< what was found, for the log of a failed test
};

/// Do the counts `observed` follow the expected ones? Both add up to the number of samples. Cells
/// that expect fewer than `pool_below` samples are pooled, smallest first, until the pool expects
/// enough; a pool that never does joins the smallest of the others. Samples where exactly none are
/// expected give p = 0.
inline ChiSquare chi_square_test(std::span<const double> observed, std::span<const double> expected,
                                 double pool_below = 5) {
  if (observed.size() != expected.size() || observed.empty())
    throw std::invalid_argument("chi_square_test needs as many observed cells as expected ones");
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    if (!(expected[i] >= 0) || !(observed[i] >= 0))
      throw std::invalid_argument("chi_square_test: cell " + std::to_string(i) + " expects " +
                                  std::to_string(expected[i]) + ", must be >= 0");
    if (expected[i] == 0 && observed[i] > 0)
      return {std::numeric_limits<double>::infinity(), 0, 0,
              "cell " + std::to_string(i) + " holds " + std::to_string(observed[i]) +
                  " samples and expects none"};
    if (expected[i] > 0) order.push_back(i);
  }
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });

  struct Cell {
    double observed = 0, expected = 0;
  };
  std::vector<Cell> cells;
  Cell pool;
  for (const std::size_t i : order) {
    pool.observed += observed[i];
    pool.expected += expected[i];
    if (pool.expected >= pool_below) {
      cells.push_back(pool);
      pool = {};
    }
  }
  if (pool.expected > 0) {
    if (cells.empty()) cells.emplace_back();
    cells.front().observed += pool.observed;
    cells.front().expected += pool.expected;
  }

  ChiSquare result;
  Cell worst;
  double worst_term = -1;
  for (const Cell& c : cells) {
    const double term = (c.observed - c.expected) * (c.observed - c.expected) / c.expected;
    result.statistic += term;
    if (term > worst_term) worst = c, worst_term = term;
  }
  result.degrees_of_freedom = static_cast<double>(cells.size()) - 1;
  // A single cell holds every sample, right or wrong.
  if (cells.size() > 1) result.p = chi_square_beyond(result.statistic, result.degrees_of_freedom);
  result.message = "chi-square " + std::to_string(result.statistic) + " with " +
                   std::to_string(cells.size()) + " cells; the worst holds " +
                   std::to_string(worst.observed) + " and expects " +
                   std::to_string(worst.expected);
  return result;
}

}  // namespace lacuna::statistics
