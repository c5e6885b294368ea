#pragma once

#include <cstdint>

#include "renderer/core/vec.h"

namespace lacuna {

/// A rectangle of an image, rendered by one thread.
struct Tile {
  V2i first{0, 0};
  V2i size{0, 0};
  /// Added to the number of the samples of its pixels (SampleNumber::index).
  std::uint64_t samples_before = 0;

  int pixels() const { return size.x * size.y; }
  V2i pixel(int i) const { return first + V2i(i % size.x, i / size.x); }
};

}  // namespace lacuna
