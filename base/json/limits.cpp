#include "base/json/limits.h"

#include <fmt/format.h>

#include <cmath>

namespace lacuna {

std::string number_text(double x) {
  if (std::abs(x) <= max_exact_integer && x == std::trunc(x)) {
    return fmt::format("{}", static_cast<std::int64_t>(x));
  }
  return fmt::format("{}", x);
}

std::string range_text(const Limits& limits) {
  const bool low = std::isfinite(limits.min);
  const bool high = std::isfinite(limits.max);
  std::string text;
  if (low && high && !limits.above_min) {
    text = fmt::format("from {} to {}", number_text(limits.min), number_text(limits.max));
  } else {
    if (low) text = (limits.above_min ? "above " : "at least ") + number_text(limits.min);
    if (low && high) text += ", ";
    if (high) text += "at most " + number_text(limits.max);
  }
  if (!text.empty() && !limits.unit.empty()) text += fmt::format(" {}", limits.unit);
  return text;
}

std::string length_text(const Limits& limits, std::string_view things) {
  const bool low = limits.min > 0;
  const bool high = std::isfinite(limits.max);
  if (low && high) {
    return fmt::format("of {} to {} {}", number_text(limits.min), number_text(limits.max), things);
  }
  if (low) return fmt::format("of at least {} {}", number_text(limits.min), things);
  if (high) return fmt::format("of at most {} {}", number_text(limits.max), things);
  return {};
}

}  // namespace lacuna
