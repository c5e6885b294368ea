#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace lacuna {

/// How heavy the tail of a positive quantity is, and whether the mean of its values can be trusted.
struct ParetoTail {
  /// Shape k of the generalized Pareto distribution that fits the largest values: moments of order
  /// 1 / k and above do not exist. Infinite where nearly all values are equal and a few are not.
  double index = 0;
  /// The mean of so many values can be trusted up to this index (Vehtari et al. 2024).
  double limit = 0;
  /// Above `threshold`, which the `share` of all values exceeds, the distribution is threshold +
  /// scale ((1 - p)^-index - 1) / index, p uniform.
  double threshold = 0, scale = 0, share = 0;

  bool mean_is_known() const { return index <= limit; }
  /// What values above the threshold add to the mean of all, up to the largest that is to be
  /// expected among `count` values. It grows with `count`: rare values are still to come.
  double mean_above(double count) const;
};

/// The fewest values of which a tail is fitted.
inline constexpr std::uint64_t least_for_a_tail = 100;

/// Fits the tail of `count` values, of which `largest` holds the largest, ascending: Zhang and
/// Stephens 2009, drawn towards 1/2 by the weight of ten values, of the largest min(.2 count, 3
/// sqrt(count)) values or those there are (Vehtari et al. 2024, "Pareto smoothed importance
/// sampling"). None of fewer than least_for_a_tail values, and where all are equal.
std::optional<ParetoTail> pareto_tail(std::span<const double> largest, std::uint64_t count);

}  // namespace lacuna
