#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "analysis/complex/plane.h"
#include "analysis/geometry/bit_grid.h"
#include "analysis/geometry/bits.h"

namespace lacuna {

/// The type of a face of a cubical complex: the set of axes along which it extends, as bits (1 x, 2
/// y, 4 z). 0 is a vertex, 7 a cube; a face's dimension is its number of bits. The face of type m
/// at cell c spans [c, c + 1] along the axes of m and lies at c along the others (thesis 5.2.1).
using FaceType = int;
inline constexpr int face_types = 8;
constexpr int dimension(FaceType m) { return (m & 1) + (m >> 1 & 1) + (m >> 2 & 1); }

/// The eight planes of one block of cells, by face type.
struct alignas(64) ComplexBlock {
  std::array<Plane, face_types> faces;
};

/// A cubical complex in a grid (thesis 5.2), eight bits a cell, in blocks of 8 x 8 x 8 cells. The
/// blocks are surrounded by a ring of empty ones, so that every block in use has all neighbours.
class CubicalComplex {
 public:
  CubicalComplex() = default;
  /// The closure of the cubes of `voxels` (5.2.2): cell (i, j, k) holds the cube of voxel (i, j,
  /// k).
  explicit CubicalComplex(const BitGrid3& voxels);

  /// Size of the grid in voxels; faces lie in cells [0, size].
  Imath::V3i size() const { return size_; }
  /// Number of blocks along each axis, including the ring.
  Imath::V3i blocks() const { return blocks_; }
  /// Total number of blocks, including the ring, for a grid of that size (checked_voxels).
  static std::uint64_t blocks_of(Imath::V3i size);
  /// Distance in memory between neighbouring blocks along an axis.
  std::ptrdiff_t stride(int axis) const {
    return axis == 0 ? 1 : axis == 1 ? blocks_.x : std::ptrdiff_t{blocks_.x} * blocks_.y;
  }
  /// Index of the block at a position in coordinates that include the ring.
  std::size_t index(int bx, int by, int bz) const {
    return static_cast<std::size_t>(bx + stride(1) * by + stride(2) * bz);
  }
  ComplexBlock* data() { return data_.data(); }
  const ComplexBlock* data() const { return data_.data(); }
  std::size_t block_count() const { return data_.size(); }
  /// The lowest cell of a block.
  Imath::V3i corner(std::size_t block) const;

  /// Whether the face of that type at `cell` (in [0, size]) is in the complex.
  bool has(Imath::V3i cell, FaceType type) const;
  void add(Imath::V3i cell, FaceType type);
  void remove(Imath::V3i cell, FaceType type);
  /// Number of faces of a dimension.
  std::size_t count(int dim) const;
  /// Vertices - edges + squares - cubes.
  std::ptrdiff_t euler() const;

  bool operator==(const CubicalComplex& o) const;

 private:
  struct BitAddress {
    std::size_t block;
    int lane, bit;
  };
  BitAddress address_of(Imath::V3i cell) const {
    return {index((cell.x >> 3) + 1, (cell.y >> 3) + 1, (cell.z >> 3) + 1), cell.z & 7,
            (cell.y & 7) * 8 + (cell.x & 7)};
  }

  Imath::V3i size_{0};
  Imath::V3i blocks_{0};
  std::vector<ComplexBlock> data_;
};

/// Number of faces, of all dimensions, of the closure of the cubes of `voxels`. Needs the memory of
/// two slices of blocks.
std::uint64_t closure_faces(const BitGrid3& voxels);

/// The bits of a plane as (position in the block, 0 to 511: x + 8 y + 64 z), ascending.
template <class F>
void for_each_bit(const Plane& plane, const F& visit) {
  const BitBlock bits = plane.bits();
  for (int z = 0; z < BitBlock::side; ++z) {
    for_each_bit(bits.z[static_cast<std::size_t>(z)], [&](int bit) { visit(z * 64 + bit); });
  }
}
/// The cell of such a position, relative to the block's first cell.
inline Imath::V3i cell_of(int position) { return {position & 7, position >> 3 & 7, position >> 6}; }

}  // namespace lacuna
