#pragma once

#include <cstddef>
#include <vector>

namespace lacuna {

/// A rectangle of pixels, from the upper left of a picture.
struct PixelRect {
  int x = 0, y = 0, width = 0, height = 0;
  bool operator==(const PixelRect&) const = default;
};

/// Whether the rectangle has pixels and lies in a picture of this size.
inline bool is_inside(const PixelRect& c, int width, int height) {
  return c.x >= 0 && c.y >= 0 && c.width > 0 && c.height > 0 && c.x <= width - c.width &&
         c.y <= height - c.height;
}

/// The rectangle's part of `pixels`, three values for each, of a picture with `width` columns, in
/// which it must lie.
template <class T>
std::vector<T> cut(const std::vector<T>& pixels, int width, const PixelRect& c) {
  std::vector<T> part;
  part.reserve(3 * static_cast<std::size_t>(c.width) * static_cast<std::size_t>(c.height));
  for (int y = c.y; y < c.y + c.height; ++y) {
    const auto row = pixels.begin() + 3 * (std::ptrdiff_t{y} * width + c.x);
    part.insert(part.end(), row, row + 3 * std::ptrdiff_t{c.width});
  }
  return part;
}

/// Rectangles of `width` x `height` in a picture of `columns` x `rows`, half a side apart. They are
/// smaller where the picture is.
std::vector<PixelRect> crop_grid(int columns, int rows, int width, int height);

}  // namespace lacuna
