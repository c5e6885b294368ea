#pragma once

#include <algorithm>
#include <limits>

#include "base/json/limits.h"
#include "base/settings/field.h"
#include "jobs/spec/described.h"

namespace lacuna {

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

/// The description of a field, with its published value if it has one.
std::string meaning_text(const Field& field);

}  // namespace lacuna
