#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lacuna {

/// Square blocks of a picture, about a thousand at most. The last ones of a row or column may be
/// smaller.
struct BlockGrid {
  int width = 0, height = 0;
  int size = 0;  ///< pixels along a side, a multiple of 16
  int across = 0, down = 0;

  BlockGrid() = default;
  BlockGrid(int w, int h) : width(w), height(h) {
    constexpr int least = 16;
    constexpr double most = 1024;
    const double side = std::sqrt(double(w) * h / most);
    size = least * std::max(1, int(std::ceil(side / least)));
    across = (w + size - 1) / size;
    down = (h + size - 1) / size;
  }
  std::size_t blocks() const { return std::size_t(across) * std::size_t(down); }
  std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
  std::size_t block_of(int x, int y) const {
    return std::size_t(y / size) * std::size_t(across) + std::size_t(x / size);
  }
  bool operator==(const BlockGrid&) const = default;
};

}  // namespace lacuna
