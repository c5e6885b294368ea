#pragma once

#include <optional>
#include <span>

namespace lacuna {

/// Coverage probability of all confidence intervals.
inline constexpr double confidence = 0.95;

struct Interval {
  double low, high;
};

/// An estimate of a positive quantity from `n` independent measurements. The interval contains the
/// true value with probability `confidence`; a single measurement has no interval.
struct Estimate {
  double value = 0;
  std::optional<Interval> interval;
  std::size_t n = 0;
};

/// The geometric mean of positive values, with Student's interval for the mean of their logarithms.
/// Errors and times of replicates vary by factors and are compared as ratios: their logarithms are
/// nearly normal, and no bound is negative. Throws std::domain_error if there is no value, or if
/// one is not positive and finite.
Estimate geometric_mean(std::span<const double> values);

/// The geometric mean of `a` over that of `b`, two independent groups that may scatter differently:
/// Welch's interval, with his degrees of freedom (Welch 1947). It needs two values in each group.
/// Throws as geometric_mean().
Estimate ratio_of_means(std::span<const double> a, std::span<const double> b);

/// Whether the interval of ratio_of_means() contains 1: the means do not differ significantly.
/// False if there is no interval. Throws as geometric_mean().
bool may_be_equal(std::span<const double> a, std::span<const double> b);

/// The least number of values whose interval is expected to be at most half as wide as that of `n`
/// >= 2 values of the same variance. It is less than 4 n, because Student's factor falls with n
/// too.
std::size_t samples_for_half(std::size_t n);

/// The plain mean of values of any sign, with Student's interval. Throws std::domain_error: no
/// value.
Estimate mean(std::span<const double> values);

}  // namespace lacuna
