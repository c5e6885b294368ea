#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>

#include "analysis/settings/field.h"
#include "jobs/spec/described.h"

namespace lacuna {

/// Largest magnitude of an integer in a document, 2^53 - 1. JSON readers that store all numbers as
/// doubles, such as the page's JavaScript, silently change larger ones.
inline constexpr double max_exact_integer = 9007199254740991.0;

/// The range of a number, or of the length of a string or list. Both ends are included, except
/// `min` if `above_min` is set.
struct Limits {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool above_min = false;
  std::string_view unit = {};

  bool allow(double x) const { return (above_min ? x > min : x >= min) && x <= max; }
};

/// The limits of a field for a number of type T: the table's and the type's.
template <class T>
Limits limits_of(const Field& field) {
  Limits limits{field.min, field.max, field.above_min, field.unit};
  if constexpr (Integer<T>) {
    const double lowest = static_cast<double>(std::numeric_limits<T>::min());
    const double highest = static_cast<double>(std::numeric_limits<T>::max());
    limits.min = std::max({limits.min, lowest, -max_exact_integer});
    limits.max = std::min({limits.max, highest, max_exact_integer});
  }
  return limits;
}

/// The limits on a length.
inline Limits length_limits(const Field& field) {
  return {std::max(field.min, 0.0), field.max, field.above_min, {}};
}

/// "12", "0.05", "1e+12": shortest text that reads back as the same number.
std::string number_text(double x);
/// "from 1 to 1024 edges", "above 0, at most 10000000 s", "at least 1"; empty: no limit.
std::string range_text(const Limits& limits);
/// "of 1 to 1024 characters", "of at most 16 elements"; empty: no limit.
std::string length_text(const Limits& limits, std::string_view things);

}  // namespace lacuna
