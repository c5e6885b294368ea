#pragma once

#include <optional>
#include <span>

#include "renderer/film/film.h"
#include "renderer/settings/output_settings.h"

namespace lacuna {

/// Every error of an estimate against a reference, over pixels and channels (DESIGN, "A job's
/// folder"). In double, of unclamped values: the only place where they are defined.
struct Errors {
  double mae = 0, rmse = 0, mse = 0, relmse = 0, smape = 0;
};

/// `estimate` and `reference` have the same size. A value that is not finite makes the errors it
/// enters not finite.
Errors errors(std::span<const double> estimate, std::span<const double> reference);

/// Mean squared error of the mean of all `na` + `nb` samples, estimated from the means `a` and `b`
/// of two independent parts: E (a - b)^2 = s^2 (1/na + 1/nb), and the mean's is s^2 / (na + nb).
double mse_from_halves(std::span<const double> a, double na, std::span<const double> b, double nb);

/// RMSE of the film's mean, from its halves; nothing before both have an iteration.
std::optional<double> estimated_rmse(const Film& film);

/// The error that `metric` names; est_rmse is not among them.
double value_of(const Errors& e, ErrorMetric metric);

}  // namespace lacuna
