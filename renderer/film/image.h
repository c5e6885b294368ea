#pragma once

#include <vector>

#include "renderer/core/vec.h"

namespace lacuna {

/// One estimate of the whole picture, the result of an iteration. Linear RGB, top row first.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), pixels(std::size_t(w) * std::size_t(h), Rgb(0, 0, 0)) {}
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(width) + std::size_t(x);
  }
  Rgb& at(int x, int y) { return pixels[index(x, y)]; }
  const Rgb& at(int x, int y) const { return pixels[index(x, y)]; }
};

}  // namespace lacuna
