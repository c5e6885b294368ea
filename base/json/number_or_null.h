#pragma once

#include <nlohmann/json.hpp>
#include <optional>

#include "base/json/json_text.h"

namespace lacuna {

/// A number of a report; null if it is not known.
inline OrderedJson number_or_null(std::optional<double> value) {
  return value ? OrderedJson(*value) : OrderedJson(nullptr);
}

}  // namespace lacuna
