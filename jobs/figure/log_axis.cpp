#include "jobs/figure/log_axis.h"

#include <fmt/format.h>

#include <algorithm>

#include "jobs/figure/page.h"

namespace lacuna {
namespace {

std::string tick_text(double value) {
  const double power = std::log10(value);
  if (std::abs(power - std::round(power)) < 1e-9 && (power < -2.5 || power > 3.5)) {
    return power_text(static_cast<int>(std::lround(power)));
  }
  return power < -3.5 || power > 4.5 ? figure_number(value) : fmt::format("{:g}", value);
}

/// Three to six round steps, for axes within a few percent to a factor of two.
std::vector<double> even_steps(const LogAxis& axis) {
  const double rough = (axis.high - axis.low) / 4;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  double step = 10 * power;
  for (const double n : {5.0, 2.0, 1.0}) {
    if (n * power >= rough) step = n * power;
  }
  std::vector<double> values;
  for (double k = std::ceil(axis.low / step); k * step <= axis.high; ++k) {
    values.push_back(k * step);
  }
  return values;
}

}  // namespace

std::vector<AxisTick> log_ticks(const LogAxis& axis, double apart) {
  std::vector<AxisTick> ticks;
  if (axis.decades() < 1.0 / 3) {
    for (const double v : even_steps(axis)) ticks.push_back({v, tick_text(v)});
  } else {
    const bool dense = axis.decades() < 2;
    const int first = static_cast<int>(std::floor(std::log10(axis.low)));
    for (int e = first; std::pow(10, e) <= axis.high; ++e) {
      for (int m = 1; m < 10; ++m) {
        const double v = m * std::pow(10, e);
        if (v < axis.low * (1 - 1e-9) || v > axis.high * (1 + 1e-9)) continue;
        const bool labelled = m == 1 || (dense && (m == 2 || m == 5));
        ticks.push_back({v, labelled ? tick_text(v) : ""});
      }
    }
  }
  // Powers of ten keep their labels before others.
  std::vector<double> taken;
  for (const bool powers : {true, false}) {
    for (AxisTick& t : ticks) {
      const double power = std::log10(t.value);
      if (t.label.empty() || (std::abs(power - std::round(power)) < 1e-9) != powers) continue;
      const double at = axis.at(t.value);
      const bool crowded = std::any_of(taken.begin(), taken.end(),
                                       [&](double other) { return std::abs(other - at) < apart; });
      if (crowded) {
        t.label.clear();
      } else {
        taken.push_back(at);
      }
    }
  }
  return ticks;
}

}  // namespace lacuna
