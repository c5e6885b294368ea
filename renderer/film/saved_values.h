#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/storage/bytes.h"
#include "renderer/film/image.h"

namespace lacuna {

/// Reads `size` values; `what` names them in errors. Throws std::runtime_error on another number of
/// values, and on non-finite values.
inline std::vector<double> get_finite(ByteReader& in, std::size_t size, const std::string& what) {
  std::vector<double> values = in.get_vector<double>();
  if (values.size() != size) throw std::runtime_error("saved " + what + " has another size");
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    throw std::runtime_error("saved " + what + " has values that are not finite");
  }
  return values;
}

static_assert(sizeof(Rgb) == 3 * sizeof(float));

inline void put_image(ByteWriter& out, const Image& image) {
  out.put(static_cast<std::uint64_t>(3 * image.pixels.size()));
  out.append(image.pixels.data(), sizeof(Rgb) * image.pixels.size());
}

/// Reads an image of the same size as `image`; `what` names it in errors. Throws std::runtime_error
/// on another size, and on non-finite values.
inline void get_image(ByteReader& in, Image& image, const std::string& what) {
  if (in.get_length(sizeof(float)) != 3 * image.pixels.size()) {
    throw std::runtime_error("saved " + what + " has another size");
  }
  in.read(image.pixels.data(), sizeof(Rgb) * image.pixels.size());
  if (!std::all_of(image.pixels.begin(), image.pixels.end(),
                   [](const Rgb& c) { return is_finite(c); })) {
    throw std::runtime_error("saved " + what + " has values that are not finite");
  }
}

}  // namespace lacuna
