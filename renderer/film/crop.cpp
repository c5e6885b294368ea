#include "renderer/film/crop.h"

#include <algorithm>

namespace lacuna {

std::vector<PixelRect> crop_grid(int columns, int rows, int width, int height) {
  const int w = std::min(width, columns), h = std::min(height, rows);
  std::vector<PixelRect> grid;
  for (int y = 0; y + h <= rows; y += std::max(1, h / 2)) {
    for (int x = 0; x + w <= columns; x += std::max(1, w / 2)) grid.push_back({x, y, w, h});
  }
  return grid;
}

}  // namespace lacuna
