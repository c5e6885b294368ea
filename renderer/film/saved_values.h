#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/storage/bytes.h"

namespace lacuna {

/// Reads `size` values; `what` names them in errors. Throws std::runtime_error on another number of
/// values, and on values that are not finite.
inline std::vector<double> get_finite(ByteReader& in, std::size_t size, const std::string& what) {
  std::vector<double> values = in.get_vector<double>();
  if (values.size() != size) throw std::runtime_error("saved " + what + " has another size");
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    throw std::runtime_error("saved " + what + " has values that are not finite");
  }
  return values;
}

}  // namespace lacuna
