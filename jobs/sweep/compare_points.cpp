#include "jobs/sweep/compare_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace lacuna {
namespace {

/// `value` rounded to this number of digits, towards `direction` (std::floor or std::ceil).
template <class Round>
double rounded(double value, int digits, Round direction) {
  const int exponent = static_cast<int>(std::floor(std::log10(value))) - digits + 1;
  // Via decimal text, because powers of ten are inexact in binary: 0.94, not 0.9400000000000001.
  return std::stod(fmt::format("{}e{}", direction(value * std::pow(10, -exponent)), exponent));
}

}  // namespace

std::vector<double> natural_times(std::span<const Replicates> cells) {
  double first = 0, last = std::numeric_limits<double>::infinity();
  for (const Replicates& cell : cells) {
    const auto common = common_times(cell);
    if (!common) continue;
    first = std::max(first, common->low);
    last = std::min(last, common->high);
  }
  std::vector<double> times;
  if (!std::isfinite(last)) return times;
  for (const double part : {10, 4, 2, 1}) {
    const double t = rounded(last / part, 3, [](double v) { return std::floor(v); });
    if (t >= first) times.push_back(t);
  }
  return times;
}

std::vector<double> natural_errors(std::span<const Replicates> cells) {
  double reached = 0, began = 0;
  for (const Replicates& cell : cells) {
    for (const ErrorCurve& curve : cell) {
      if (curve.empty()) continue;
      reached = std::max(reached, curve.points().back().error);
      began = std::max(began, curve.points().front().error);
    }
  }
  if (reached == 0) return {};
  const double error = rounded(reached, 2, [](double v) { return std::ceil(v); });
  if (began > 2 * error) return {2 * error, error};
  return {error};
}

}  // namespace lacuna
