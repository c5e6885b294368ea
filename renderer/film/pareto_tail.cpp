#include "renderer/film/pareto_tail.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lacuna {
namespace {

constexpr std::size_t least_exceedances = 5;

/// The mean of log(1 - theta x): the shape k for theta = -k / sigma.
double shape(std::span<const double> x, double theta) {
  double sum = 0;
  for (const double v : x) sum += std::log1p(-theta * v);
  return sum / double(x.size());
}

/// The shape of a generalized Pareto distribution fitted to `x` > 0, ascending: theta is the mean
/// over a grid, weighted by the profile likelihood (Zhang and Stephens 2009).
double fitted_shape(std::span<const double> x) {
  constexpr double prior = 3;
  const auto n = double(x.size());
  const double quartile = x[std::size_t(std::lround(n / 4)) - 1];
  const int points = 30 + int(std::sqrt(n));
  std::vector<double> theta, likelihood;
  for (int j = 1; j <= points; ++j) {
    theta.push_back(1 / x.back() + (1 - std::sqrt(points / (j - 0.5))) / (prior * quartile));
    const double k = shape(x, theta.back());
    likelihood.push_back(n * (std::log(-theta.back() / k) - k - 1));
  }
  double weights = 0, mean = 0;
  const double best = *std::max_element(likelihood.begin(), likelihood.end());
  for (std::size_t j = 0; j < theta.size(); ++j) {
    const double weight = std::exp(likelihood[j] - best);
    weights += weight;
    mean += weight * theta[j];
  }
  return shape(x, mean / weights);
}

}  // namespace

std::optional<ParetoTail> pareto_tail(std::span<const double> largest, std::uint64_t count) {
  if (count < least_for_a_tail || largest.empty()) return {};
  const auto n = double(count);
  const auto wanted = std::size_t(std::min(0.2 * n, 3 * std::sqrt(n)));
  const std::size_t tail = std::min(wanted, largest.size() - 1);
  const double threshold = largest[largest.size() - 1 - tail];
  // Relative to the largest value: squares of radiances may approach either end of double's range.
  const double scale = largest.back() - threshold;
  if (!(scale > 0)) return {};
  std::vector<double> exceedances;
  for (const double v : largest.last(tail)) {
    if (v > threshold) exceedances.push_back((v - threshold) / scale);
  }
  ParetoTail result{.index = std::numeric_limits<double>::infinity(),
                    .limit = std::min(1 - 1 / std::log10(n), 0.7)};
  if (exceedances.size() < least_exceedances) return result;
  const auto m = double(exceedances.size());
  result.index = (m * fitted_shape(exceedances) + 5) / (m + 10);
  return result;
}

}  // namespace lacuna
