#pragma once

#include <array>
#include <optional>
#include <span>

#include "renderer/film/film.h"
#include "renderer/settings/error_metrics.h"

namespace lacuna {

/// The errors of an estimate against a reference: of each metric that needs one
/// (renderer/settings/error_metrics.h) its value, in the table's order.
struct Errors {
  std::array<double, reference_metrics> values{};

  /// Throws std::invalid_argument for a metric that needs no reference.
  double operator[](ErrorMetric metric) const;
};

/// In double, of unclamped values. `estimate` and `reference` have the same size. A value that is
/// not finite makes the errors it enters not finite.
Errors errors(std::span<const double> estimate, std::span<const double> reference);

/// Mean squared error of the mean of all `na` + `nb` samples, estimated from the means `a` and `b`
/// of two independent parts: E (a - b)^2 = s^2 (1/na + 1/nb), and the mean's is s^2 / (na + nb).
double mse_from_halves(std::span<const double> a, double na, std::span<const double> b, double nb);

/// RMSE of the film's mean, from its halves; nothing before both have an iteration.
std::optional<double> estimated_rmse(const Film& film);

}  // namespace lacuna
