#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "base/settings/field.h"

namespace lacuna {

/// Error of an estimate x against a reference r, over pixels and channels. Smaller is better.
enum class ErrorMetric { mae, rmse, mse, relmse, smape, flip, est_rmse };

constexpr double squared_error(double x, double r) { return (x - r) * (x - r); }

/// The definition of an error metric. Film, curve.csv, reports, comparisons, the schema and the
/// page use the names and definitions of this table.
struct ErrorMetricRow {
  ErrorMetric value;
  std::string_view name;   ///< in files
  std::string_view doc;    ///< definition
  std::string_view label;  ///< in tables and figures
  std::string_view unit = {};
  bool squared = false;  ///< decreases as 1 / samples; the others as 1 / sqrt(samples)
  bool needs_reference = true;
  /// If given, the error is the mean of term(x, r) over pixels and channels.
  double (*term)(double x, double r) = nullptr;
  bool root = false;  ///< the error is the square root of that mean
};

/// In the order of the enumerators, which is the order of the columns of curve.csv.
template <>
struct EnumTable<ErrorMetric> {
  static constexpr std::array<ErrorMetricRow, 7> values{{
      {.value = ErrorMetric::mae,
       .name = "mae",
       .doc = "mean |x - r|",
       .label = "MAE",
       .unit = "radiance",
       .term = [](double x, double r) { return std::abs(x - r); }},
      {.value = ErrorMetric::rmse,
       .name = "rmse",
       .doc = "square root of mse",
       .label = "RMSE",
       .unit = "radiance",
       .term = squared_error,
       .root = true},
      {.value = ErrorMetric::mse,
       .name = "mse",
       .doc = "mean (x - r)^2",
       .label = "MSE",
       .unit = "radiance²",
       .squared = true,
       .term = squared_error},
      {.value = ErrorMetric::relmse,
       .name = "relmse",
       .doc = "mean (x - r)^2 / (r^2 + 0.01)",
       .label = "relMSE",
       .squared = true,
       .term = [](double x, double r) { return squared_error(x, r) / (r * r + 0.01); }},
      {.value = ErrorMetric::smape,
       .name = "smape",
       .doc = "mean |x - r| / ((|x| + |r|) / 2 + 0.01)",
       .label = "SMAPE",
       .term = [](double x,
                  double r) { return std::abs(x - r) / ((std::abs(x) + std::abs(r)) / 2 + 0.01); }},
      {.value = ErrorMetric::flip,
       .name = "flip",
       .doc = "mean HDR-FLIP, the difference that a person sees: 0 to 1 (docs/numbers.md)",
       .label = "FLIP"},
      {.value = ErrorMetric::est_rmse,
       .name = "est_rmse",
       .doc = "rmse estimated from two independent halves; needs no reference",
       .label = "estimated RMSE",
       .unit = "radiance",
       .needs_reference = false},
  }};
};

inline constexpr auto& error_metrics = EnumTable<ErrorMetric>::values;

constexpr const ErrorMetricRow& row_of(ErrorMetric metric) {
  return error_metrics[static_cast<std::size_t>(metric)];
}

constexpr bool needs_reference(ErrorMetric metric) { return row_of(metric).needs_reference; }

/// Number of metrics that are means of terms; these come first.
inline constexpr std::size_t mean_metrics = static_cast<std::size_t>(std::ranges::count_if(
    error_metrics, [](const ErrorMetricRow& row) { return row.term != nullptr; }));

static_assert([] {
  for (std::size_t i = 0; i < error_metrics.size(); ++i) {
    if (static_cast<std::size_t>(error_metrics[i].value) != i) return false;
    if ((error_metrics[i].term != nullptr) != (i < mean_metrics)) return false;
  }
  return true;
}());

/// The metric shown by default.
constexpr ErrorMetric usual_metric(bool has_reference) {
  return has_reference ? ErrorMetric::relmse : ErrorMetric::est_rmse;
}

}  // namespace lacuna
