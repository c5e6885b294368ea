#pragma once

#include <cmath>
#include <string>
#include <vector>

namespace lacuna {

/// A logarithmic axis from `low` to `high`, both above 0, drawn from `from` to `to`.
struct LogAxis {
  double low, high, from, to;

  double at(double value) const {
    return from + (to - from) * std::log(value / low) / std::log(high / low);
  }
  double decades() const { return std::log10(high / low); }
};

struct AxisTick {
  double value;
  std::string label;  ///< empty: a small tick
};

/// Ticks in the axis' range: powers of ten with labels and their multiples without; on less than
/// two decades also labels at 2 and 5, and on less than a third round steps. Labels are at
/// least `apart` points from each other.
std::vector<AxisTick> log_ticks(const LogAxis& axis, double apart);

}  // namespace lacuna
