#pragma once

#include <array>
#include <optional>
#include <span>

#include "renderer/film/film.h"
#include "renderer/settings/error_metrics.h"

namespace lacuna {

/// The errors of an estimate against a reference: one value for each metric that is a mean of
/// terms, in the order of renderer/settings/error_metrics.h.
struct Errors {
  std::array<double, mean_metrics> values{};

  /// Throws std::invalid_argument for a metric that is no mean of terms.
  double operator[](ErrorMetric metric) const;
};

/// Computes all errors in double, from unclamped values. `estimate` and `reference` have the same
/// size. A non-finite value makes the errors non-finite.
Errors errors(std::span<const double> estimate, std::span<const double> reference);

/// Mean squared error of the mean of all `na` + `nb` samples, estimated from the means `a` and `b`
/// of two independent parts (scale_from_halves()).
double mse_from_halves(std::span<const double> a, double na, std::span<const double> b, double nb);

/// RMSE of the film's mean, from its halves; none before both halves have an iteration.
std::optional<double> estimated_rmse(const Film& film);

}  // namespace lacuna
