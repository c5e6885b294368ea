#include "jobs/sweep/estimate.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "jobs/sweep/distributions.h"

namespace lacuna {
namespace {

struct Moments {
  double mean = 0;
  double variance_of_mean = 0;  ///< 0 for one value
  std::size_t n = 0;

  double df() const { return static_cast<double>(n - 1); }
};

Moments moments(std::span<const double> values) {
  if (values.empty()) throw std::domain_error("an estimate needs a value");
  Moments m{0, 0, values.size()};
  const auto n = static_cast<double>(m.n);
  for (const double v : values) m.mean += v / n;
  if (m.n < 2) return m;
  for (const double v : values) m.variance_of_mean += (v - m.mean) * (v - m.mean) / (n - 1) / n;
  return m;
}

Moments moments_of_logs(std::span<const double> values) {
  std::vector<double> logs;
  for (const double v : values) {
    if (!(v > 0) || !std::isfinite(v)) {
      throw std::domain_error("a geometric mean needs positive values");
    }
    logs.push_back(std::log(v));
  }
  return moments(logs);
}

Estimate around_exp(double centre, std::optional<double> half_width, std::size_t n) {
  Estimate e{std::exp(centre), {}, n};
  if (half_width) e.interval = {std::exp(centre - *half_width), std::exp(centre + *half_width)};
  return e;
}

std::optional<double> half_width(const Moments& m) {
  if (m.n < 2) return {};
  return student_bound(confidence, m.df()) * std::sqrt(m.variance_of_mean);
}

/// Difference of the means of two groups, with Welch's degrees of freedom.
struct Difference {
  Difference(const Moments& a, const Moments& b)
      : mean(a.mean - b.mean),
        variance(a.variance_of_mean + b.variance_of_mean),
        n(std::min(a.n, b.n)) {
    if (n < 2 || variance == 0) return;
    const double va = a.variance_of_mean, vb = b.variance_of_mean;
    df = variance * variance / (va * va / a.df() + vb * vb / b.df());
  }
  double mean, variance;
  std::size_t n;
  double df = 0;
};

}  // namespace

Estimate geometric_mean(std::span<const double> values) {
  const Moments m = moments_of_logs(values);
  return around_exp(m.mean, half_width(m), m.n);
}

Estimate ratio_of_means(std::span<const double> a, std::span<const double> b) {
  const Difference d(moments_of_logs(a), moments_of_logs(b));
  if (d.n < 2) return around_exp(d.mean, {}, d.n);
  if (d.variance == 0) return around_exp(d.mean, 0.0, d.n);
  return around_exp(d.mean, student_bound(confidence, d.df) * std::sqrt(d.variance), d.n);
}

bool may_be_equal(std::span<const double> a, std::span<const double> b) {
  const Difference d(moments_of_logs(a), moments_of_logs(b));
  if (d.n < 2) return false;
  if (d.variance == 0) return d.mean == 0;
  return student_within(std::abs(d.mean) / std::sqrt(d.variance), d.df) <= confidence;
}

std::size_t samples_for_half(std::size_t n) {
  if (n < 2) throw std::domain_error("one value has no interval");
  const auto width = [](std::size_t m) {
    return student_bound(confidence, static_cast<double>(m - 1)) /
           std::sqrt(static_cast<double>(m));
  };
  const double half = width(n) / 2;
  std::size_t below = n, enough = 4 * n;  // Student's factor falls: 4 n is always enough
  while (enough - below > 1) {
    const std::size_t m = (below + enough) / 2;
    (width(m) <= half ? enough : below) = m;
  }
  return enough;
}

Estimate mean(std::span<const double> values) {
  const Moments m = moments(values);
  Estimate e{m.mean, {}, m.n};
  if (const auto half = half_width(m)) e.interval = {m.mean - *half, m.mean + *half};
  return e;
}

}  // namespace lacuna
