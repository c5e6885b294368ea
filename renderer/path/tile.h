#pragma once

#include <algorithm>

#include "renderer/core/vec.h"

namespace lacuna {

/// A rectangle of an image, rendered by one thread.
struct Tile {
  V2i first{0, 0};
  V2i size{0, 0};

  int pixels() const { return size.x * size.y; }
  bool contains(const V2i& p) const {
    return p.x >= first.x && p.y >= first.y && p.x < first.x + size.x && p.y < first.y + size.y;
  }
  V2i pixel(int i) const { return first + V2i(i % size.x, i / size.x); }

  /// Pixels along a side of the blocks whose paths are traced together. Blocks begin at multiples
  /// of it. If tiles do too, the block of a pixel, and the packet of its camera ray, do not depend
  /// on how the picture is divided into tiles.
  static constexpr int block_side = 8;
  int blocks() const { return blocks_along(0) * blocks_along(1); }
  /// Block number `i`, clipped to the tile.
  Tile block(int i) const {
    const int across = blocks_along(0);
    const V2i corner = (first / block_side + V2i(i % across, i / across)) * block_side;
    const V2i from(std::max(first.x, corner.x), std::max(first.y, corner.y));
    const V2i end(std::min(first.x + size.x, corner.x + block_side),
                  std::min(first.y + size.y, corner.y + block_side));
    return {from, end - from};
  }
  /// Pixel number `i` of a block. In a whole block, eight consecutive ones (a packet) are a
  /// rectangle of 4 x 2 pixels.
  V2i pixel_of_block(int i) const {
    if (size != V2i(block_side)) return pixel(i);
    return first + V2i(i % 4 + i / 8 % 2 * 4, i / 4 % 2 + i / 16 * 2);
  }

 private:
  int blocks_along(int axis) const {
    return (first[axis] + size[axis] - 1) / block_side - first[axis] / block_side + 1;
  }
};

}  // namespace lacuna
