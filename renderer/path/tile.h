#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// A rectangle of an image, rendered by one thread.
struct Tile {
  V2i first{0, 0};
  V2i size{0, 0};

  int pixels() const { return size.x * size.y; }
  V2i pixel(int i) const { return first + V2i(i % size.x, i / size.x); }
};

}  // namespace lacuna
