#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lacuna {

/// Square blocks of a picture, about a thousand at most. The last ones of a row or column may be
/// smaller. Trials may render smaller pictures of the same view (Camera::reduced()).
struct BlockGrid {
  int width = 0, height = 0;  ///< of the picture
  int size = 0;               ///< pixels along a side, a multiple of 16
  int across = 0, down = 0;
  int reduction = 1;  ///< a pixel of a trial is so many of the picture's along a side

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
  int trial_width() const { return (width + reduction - 1) / reduction; }
  int trial_height() const { return (height + reduction - 1) / reduction; }
  std::size_t trial_pixels() const {
    return std::size_t(trial_width()) * std::size_t(trial_height());
  }
  double trial_share() const { return double(trial_pixels()) / double(pixels()); }
  /// Of a trial's pixel (x, y): the block of its centre, or of what the picture has of it.
  std::size_t block_of(int x, int y) const {
    const int u = std::min(x * reduction + reduction / 2, width - 1);
    const int v = std::min(y * reduction + reduction / 2, height - 1);
    return std::size_t(v / size) * std::size_t(across) + std::size_t(u / size);
  }
  /// Of a trial's pixel: how many of the picture's it stands for.
  double weight(int x, int y) const {
    return double(std::min(reduction, width - x * reduction)) *
           double(std::min(reduction, height - y * reduction));
  }
  bool operator==(const BlockGrid&) const = default;
};

}  // namespace lacuna
