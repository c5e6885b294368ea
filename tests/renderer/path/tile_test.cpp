// The blocks of a tile: each pixel is in one, and which camera rays share a packet depends on the
// picture alone, not on how it is divided into tiles.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "renderer/path/tile.h"

namespace lacuna {
namespace {

using Pixel = std::pair<int, int>;
constexpr int packet = 8;

/// The pixels that share a packet with each pixel of a picture which is divided into tiles of
/// `of_tile` pixels.
std::map<Pixel, std::set<Pixel>> packets(const V2i& size, const V2i& of_tile) {
  std::map<Pixel, std::set<Pixel>> result;
  for (int y = 0; y < size.y; y += of_tile.y) {
    for (int x = 0; x < size.x; x += of_tile.x) {
      const Tile tile{{x, y}, {std::min(of_tile.x, size.x - x), std::min(of_tile.y, size.y - y)}};
      for (int b = 0; b < tile.blocks(); ++b) {
        const Tile block = tile.block(b);
        EXPECT_LE(block.pixels(), Tile::block_side * Tile::block_side);
        for (int first = 0; first < block.pixels(); first += packet) {
          std::set<Pixel> together;
          for (int i = first; i < std::min(first + packet, block.pixels()); ++i) {
            const V2i p = block.pixel_of_block(i);
            together.emplace(p.x, p.y);
          }
          for (const Pixel& p : together) {
            EXPECT_TRUE(result.emplace(p, together).second) << p.first << ", " << p.second;
          }
        }
      }
    }
  }
  return result;
}

TEST(Tile, EachPixelIsInOneBlock) {
  for (const V2i& size : {V2i(1, 1), V2i(7, 9), V2i(8, 8), V2i(37, 21), V2i(64, 48)}) {
    const auto all = packets(size, size);
    EXPECT_EQ(all.size(), static_cast<std::size_t>(size.x * size.y));
    EXPECT_EQ(all.begin()->first, Pixel(0, 0));
    EXPECT_EQ(all.rbegin()->first, Pixel(size.x - 1, size.y - 1));
  }
  // A tile that does not begin at a block.
  const Tile odd{{5, 3}, {14, 9}};
  std::set<Pixel> met;
  for (int b = 0; b < odd.blocks(); ++b) {
    const Tile block = odd.block(b);
    for (int i = 0; i < block.pixels(); ++i) {
      const V2i p = block.pixel_of_block(i);
      EXPECT_TRUE(met.emplace(p.x, p.y).second);
      EXPECT_TRUE(p.x >= 5 && p.x < 19 && p.y >= 3 && p.y < 12);
    }
  }
  EXPECT_EQ(met.size(), 14U * 9U);
}

TEST(Tile, PacketsDoNotDependOnTiles) {
  for (const V2i& size : {V2i(100, 53), V2i(19, 70)}) {
    const auto whole = packets(size, size);
    for (const V2i& of_tile : {V2i(8, 8), V2i(32, 32), V2i(64, 16), V2i(16, 48)}) {
      EXPECT_EQ(packets(size, of_tile), whole);
    }
  }
}

TEST(Tile, NeighboursShareAPacket) {
  for (const auto& [pixel, together] : packets({32, 32}, {32, 32})) {
    EXPECT_EQ(together.begin()->first / 4, pixel.first / 4);
    EXPECT_EQ(together.rbegin()->first / 4, pixel.first / 4);
    EXPECT_EQ(together.begin()->second / 2, pixel.second / 2);
    EXPECT_EQ(together.rbegin()->second / 2, pixel.second / 2);
  }
}

}  // namespace
}  // namespace lacuna
