#pragma once

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "analysis/storage/bytes.h"
#include "renderer/film/image.h"

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

inline void put_image(ByteWriter& out, const Image& image) {
  std::vector<float> values;
  values.reserve(3 * image.pixels.size());
  for (const Rgb& c : image.pixels) values.insert(values.end(), {c.x, c.y, c.z});
  out.put(values);
}

/// Reads an image of the same size; `what` names it in errors. Throws std::runtime_error on another
/// size, and on values that are not finite.
inline void get_image(ByteReader& in, Image& image, const std::string& what) {
  const std::vector<float> values = in.get_vector<float>();
  if (values.size() != 3 * image.pixels.size()) {
    throw std::runtime_error("saved " + what + " has another size");
  }
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    image.pixels[i] = Rgb(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
    if (!is_finite(image.pixels[i])) {
      throw std::runtime_error("saved " + what + " has values that are not finite");
    }
  }
}

}  // namespace lacuna
