#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace lacuna::test {

/// The unevaluated sum of two doubles, 106 bits: a reference for what is added up in double.
struct DoubleDouble {
  double high = 0, low = 0;

  /// Exact: the sum and its rounding error (Knuth 1969).
  static DoubleDouble sum(double a, double b) {
    const double s = a + b;
    const double part = s - a;
    return {s, (a - (s - part)) + (b - part)};
  }
  /// Exact: the product and its rounding error, by a fused multiply-add.
  static DoubleDouble product(double a, double b) { return {a * b, std::fma(a, b, -a * b)}; }

  DoubleDouble operator+(const DoubleDouble& o) const {
    const DoubleDouble s = sum(high, o.high), t = sum(low, o.low);
    const DoubleDouble once = sum(s.high, s.low + t.high);
    return sum(once.high, once.low + t.low);
  }
  DoubleDouble operator-() const { return {-high, -low}; }
  DoubleDouble operator*(const DoubleDouble& o) const {
    const DoubleDouble p = product(high, o.high);
    return sum(p.high, p.low + (high * o.low + low * o.high));
  }
  DoubleDouble operator/(double n) const {
    const double first = high / n;
    const DoubleDouble rest = *this + -product(first, n);
    return sum(first, (rest.high + rest.low) / n);
  }
  double value() const { return high + low; }
};

/// Mean of some numbers and the variance of that mean, and how far an accumulation in double may be
/// off.
struct ExactMoments {
  double mean = 0, variance_of_mean = 0;
  double mean_bound = 0, variance_bound = 0;  ///< absolute
};

/// At least two numbers, at most 1e7 (the bounds' constants).
///
/// The bounds are those of Welford's recurrence m_k = m_{k-1} + (v_k - m_{k-1}) / k, which holds
/// for any split into two halves as well. With u = 2^-53, e_k = the error of m_k and A = the mean
/// of |v|: k |e_k| <= (k - 1) |e_{k-1}| + 3 u |v_k - m_{k-1}| + u k |m_k| (one rounding each of the
/// difference, the share, their product, and the sum). Adding up, with k |m_k| <= N A and the mean
/// of the |m_k| <= A (1 + ln N):
///
///     |e_N| <= u A (N + 6 + 3 ln N) <= u A (N + 64).
///
/// The squares d_k (v_k - m_k) are of one sign; each carries 3 u of itself and |d_k| (|e_k| +
/// |e_{k-1}|), their sum N u of itself. With Cauchy and Schwarz, sum |d_k| <= sqrt(2 N M2):
///
///     |error of M2| <= u M2 [N + 8 + 3 (A / sigma) (N + 83 sqrt N)],  sigma^2 = M2 / N.
inline ExactMoments exact_moments(const std::vector<double>& values) {
  constexpr double u = std::numeric_limits<double>::epsilon() / 2;
  const auto n = static_cast<double>(values.size());
  DoubleDouble sum, size, squares;
  for (const double v : values) {
    sum = sum + DoubleDouble{v};
    size = size + DoubleDouble{std::abs(v)};
  }
  const DoubleDouble mean = sum / n;
  for (const double v : values) {
    const DoubleDouble d = DoubleDouble{v} + -mean;
    squares = squares + d * d;
  }
  const double mean_size = size.value() / n, m2 = squares.value();
  ExactMoments exact{mean.value(), m2 / (n - 1) / n, u * mean_size * (n + 64), 0};
  if (m2 > 0) {
    const double sigma = std::sqrt(m2 / n);
    exact.variance_bound =
        u * exact.variance_of_mean * (n + 8 + 3 * mean_size / sigma * (n + 83 * std::sqrt(n)));
  }
  return exact;
}

}  // namespace lacuna::test
