#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacuna {

/// 8 x 8 x 8 cells, one bit each: word z, byte y, bit x. One cache line.
struct alignas(64) BitBlock {
  std::array<std::uint64_t, 8> z{};

  static constexpr int side = 8;
  bool operator==(const BitBlock&) const = default;
  bool any() const {
    std::uint64_t all = 0;
    for (const std::uint64_t w : z) all |= w;
    return all != 0;
  }
  int count() const {
    int n = 0;
    for (const std::uint64_t w : z) n += std::popcount(w);
    return n;
  }
};

/// One bit for every voxel of a grid, in blocks of 8 x 8 x 8, blocks x fastest. Bits beyond the
/// size, in the last blocks, are always 0.
class BitGrid3 {
 public:
  BitGrid3() = default;
  /// All bits 0.
  explicit BitGrid3(Imath::V3i size)
      : size_(size),
        blocks_((size + Imath::V3i(BitBlock::side - 1)) / BitBlock::side),
        data_(static_cast<std::size_t>(blocks_.x) * static_cast<std::size_t>(blocks_.y) *
              static_cast<std::size_t>(blocks_.z)) {}

  Imath::V3i size() const { return size_; }
  Imath::V3i blocks() const { return blocks_; }
  std::size_t block_index(int bx, int by, int bz) const {
    return (static_cast<std::size_t>(bz) * static_cast<std::size_t>(blocks_.y) +
            static_cast<std::size_t>(by)) *
               static_cast<std::size_t>(blocks_.x) +
           static_cast<std::size_t>(bx);
  }
  BitBlock& block(int bx, int by, int bz) { return data_[block_index(bx, by, bz)]; }
  const BitBlock& block(int bx, int by, int bz) const { return data_[block_index(bx, by, bz)]; }
  std::vector<BitBlock>& data() { return data_; }
  const std::vector<BitBlock>& data() const { return data_; }

  bool get(int x, int y, int z) const {
    return (block(x >> 3, y >> 3, z >> 3).z[static_cast<std::size_t>(z & 7)] >> bit(x, y) & 1) != 0;
  }
  bool get(Imath::V3i v) const { return get(v.x, v.y, v.z); }
  void set(int x, int y, int z) {
    block(x >> 3, y >> 3, z >> 3).z[static_cast<std::size_t>(z & 7)] |= std::uint64_t{1}
                                                                        << bit(x, y);
  }
  void set(Imath::V3i v) { set(v.x, v.y, v.z); }
  void reset(Imath::V3i v) {
    block(v.x >> 3, v.y >> 3, v.z >> 3).z[static_cast<std::size_t>(v.z & 7)] &=
        ~(std::uint64_t{1} << bit(v.x, v.y));
  }
  /// Number of bits that are 1.
  std::size_t count() const {
    std::size_t n = 0;
    for (const BitBlock& b : data_) n += static_cast<std::size_t>(b.count());
    return n;
  }
  bool operator==(const BitGrid3&) const = default;

 private:
  static int bit(int x, int y) { return (y & 7) * 8 + (x & 7); }

  Imath::V3i size_{0};
  Imath::V3i blocks_{0};
  std::vector<BitBlock> data_;
};

}  // namespace lacuna
