#pragma once

#include <limits>
#include <string>
#include <string_view>

namespace lacuna {

/// Largest magnitude of an integer in a document, 2^53 - 1: beyond it JSON readers that hold every
/// number in a double (the page's JavaScript among them) change it silently.
inline constexpr double max_exact_integer = 9007199254740991.0;

/// The range of a number, or of the length of a string or list. Inclusive, except `min` if
/// `above_min` is set.
struct Limits {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;
  std::string_view unit = {};

  bool allow(double x) const { return (above_min ? x > min : x >= min) && x <= max; }
};

/// "12", "0.05", "1e+12": the shortest text that parses to the same number.
std::string number_text(double x);
/// "from 1 to 1024 edges", "above 0, at most 10000000 s", "at least 1"; empty: no limit.
std::string range_text(const Limits& limits);
/// "of 1 to 1024 characters", "of at most 16 elements"; empty: no limit.
std::string length_text(const Limits& limits, std::string_view things);

}  // namespace lacuna
