#include "renderer/film/metrics.h"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace lacuna {
namespace {

/// Adds the terms of a pair of values to the sum of every metric. Unrolled over the metrics, so
/// that each term is inlined.
template <std::size_t... M>
void add_terms(Errors& sums, double x, double r, std::index_sequence<M...>) {
  ((sums.values[M] += error_metrics[M].term(x, r)), ...);
}

}  // namespace

double Errors::operator[](ErrorMetric metric) const {
  if (row_of(metric).term != nullptr) return values[static_cast<std::size_t>(metric)];
  throw std::invalid_argument(std::string(enum_name(metric)) + " is no mean of terms");
}

Errors errors(std::span<const double> estimate, std::span<const double> reference) {
  if (estimate.size() != reference.size()) {
    throw std::invalid_argument("the two pictures have different sizes");
  }
  Errors e;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    add_terms(e, estimate[i], reference[i], std::make_index_sequence<mean_metrics>());
  }
  const auto n = static_cast<double>(estimate.size());
  for (std::size_t m = 0; m < mean_metrics; ++m) {
    e.values[m] /= n;
    if (error_metrics[m].root) e.values[m] = std::sqrt(e.values[m]);
  }
  return e;
}

double mse_from_halves(std::span<const double> a, double na, std::span<const double> b, double nb) {
  return errors(a, b)[ErrorMetric::mse] * scale_from_halves(na, nb);
}

std::optional<double> estimated_rmse(const Film& film) {
  const auto even = static_cast<double>(film.half_iterations(0));
  const auto odd = static_cast<double>(film.half_iterations(1));
  if (even == 0 || odd == 0) return std::nullopt;
  return std::sqrt(mse_from_halves(film.half_mean(0), even, film.half_mean(1), odd));
}

}  // namespace lacuna
