#pragma once

#include <optional>
#include <span>

namespace lacuna {

/// Probability with which the intervals of this project hold the truth.
inline constexpr double confidence = 0.95;

struct Interval {
  double low, high;
};

/// A positive quantity known from `n` independent measurements. The interval holds the truth with
/// probability `confidence`; one measurement alone tells nothing of its own spread and has none.
struct Estimate {
  double value = 0;
  std::optional<Interval> interval;
  std::size_t n = 0;
};

/// The geometric mean of positive values, with Student's interval for the mean of their logarithms.
/// Errors and times of replicates scatter by factors, and what is asked of them are ratios: both
/// are even on this scale, and no bound is negative. Throws std::domain_error: no value, or one
/// that is not positive and finite.
Estimate geometric_mean(std::span<const double> values);

/// The geometric mean of `a` over that of `b`, two independent groups that may scatter differently:
/// Welch's interval, with his degrees of freedom (Welch 1947). It needs two values in each group.
/// Throws as geometric_mean().
Estimate ratio_of_means(std::span<const double> a, std::span<const double> b);

/// Whether the interval of ratio_of_means() holds 1: which of the two is larger is left open.
/// Throws likewise; false where there is no interval.
bool may_be_equal(std::span<const double> a, std::span<const double> b);

/// The least number of values whose interval is expected to be at most half as wide as that of `n`
/// >= 2 values of equal scatter: less than 4 n, as Student's factor falls too.
std::size_t samples_for_half(std::size_t n);

/// The plain mean of values of any sign, with Student's interval. Throws std::domain_error: no
/// value.
Estimate mean(std::span<const double> values);

}  // namespace lacuna
