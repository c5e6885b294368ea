#include "renderer/film/metrics.h"

#include <cmath>
#include <stdexcept>

namespace lacuna {

Errors errors(std::span<const double> estimate, std::span<const double> reference) {
  if (estimate.size() != reference.size()) {
    throw std::invalid_argument("the two pictures have different sizes");
  }
  Errors e;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    const double x = estimate[i];
    const double r = reference[i];
    const double d = x - r;
    e.mae += std::abs(d);
    e.mse += d * d;
    e.relmse += d * d / (r * r + 0.01);
    e.smape += std::abs(d) / ((std::abs(x) + std::abs(r)) / 2 + 0.01);
  }
  const auto n = static_cast<double>(estimate.size());
  e.mae /= n;
  e.mse /= n;
  e.relmse /= n;
  e.smape /= n;
  e.rmse = std::sqrt(e.mse);
  return e;
}

double mse_from_halves(std::span<const double> a, double na, std::span<const double> b, double nb) {
  return errors(a, b).mse * na * nb / ((na + nb) * (na + nb));
}

std::optional<double> estimated_rmse(const Film& film) {
  const auto even = static_cast<double>(film.half_iterations(0));
  const auto odd = static_cast<double>(film.half_iterations(1));
  if (even == 0 || odd == 0) return std::nullopt;
  return std::sqrt(mse_from_halves(film.half_mean(0), even, film.half_mean(1), odd));
}

double value_of(const Errors& e, ErrorMetric metric) {
  switch (metric) {
    case ErrorMetric::mae:
      return e.mae;
    case ErrorMetric::rmse:
      return e.rmse;
    case ErrorMetric::mse:
      return e.mse;
    case ErrorMetric::relmse:
      return e.relmse;
    case ErrorMetric::smape:
      return e.smape;
    case ErrorMetric::est_rmse:
      break;
  }
  throw std::invalid_argument("est_rmse is not measured against a reference");
}

}  // namespace lacuna
