#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace lacuna {

/// The tail of the distribution of a positive quantity: how heavy it is, and whether the mean of
/// the values is reliable.
struct ParetoTail {
  /// Shape k of the generalized Pareto distribution fitted to the largest values: moments of order
  /// 1 / k and above do not exist. Infinite if nearly all values are equal and a few are not.
  double index = 0;
  /// The mean of this number of values is reliable up to this index (Vehtari et al. 2024).
  double limit = 0;

  bool mean_is_known() const { return index <= limit; }
};

/// The minimum number of values for fitting a tail.
inline constexpr std::uint64_t least_for_a_tail = 100;

/// Fits the tail of `count` values. `largest` contains the largest of them, ascending; the fit uses
/// the largest min(.2 count, 3 sqrt(count)) values, or all of `largest` if it has fewer (Vehtari et
/// al. 2024, "Pareto smoothed importance sampling"). The estimator is Zhang and Stephens 2009,
/// shrunk towards 1/2 with the weight of ten values. None for fewer than least_for_a_tail values,
/// and if all are equal.
std::optional<ParetoTail> pareto_tail(std::span<const double> largest, std::uint64_t count);

}  // namespace lacuna
