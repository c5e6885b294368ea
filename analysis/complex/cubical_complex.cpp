#include "analysis/complex/cubical_complex.h"

namespace lacuna {

namespace {

Imath::V3i ringed_blocks(Imath::V3i size) {
  return (size + Imath::V3i(BitBlock::side)) / BitBlock::side + Imath::V3i(2);
}

}  // namespace

std::uint64_t CubicalComplex::blocks_of(Imath::V3i size) {
  const Imath::V3i n = ringed_blocks(size);
  return static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(n.y) *
         static_cast<std::uint64_t>(n.z);
}

CubicalComplex::CubicalComplex(const BitGrid3& voxels)
    : size_(voxels.size()), blocks_(ringed_blocks(size_)), data_(blocks_of(size_)) {
  const std::ptrdiff_t sx = stride(0), sy = stride(1), sz = stride(2);
  // Ascending: the blocks below are complete when their faces are needed.
  for (int bz = 1; bz < blocks_.z - 1; ++bz) {
    for (int by = 1; by < blocks_.y - 1; ++by) {
      for (int bx = 1; bx < blocks_.x - 1; ++bx) {
        ComplexBlock* b = data_.data() + index(bx, by, bz);
        auto& f = b->faces;
        const Imath::V3i v(bx - 1, by - 1, bz - 1);
        const bool inside =
            v.x < voxels.blocks().x && v.y < voxels.blocks().y && v.z < voxels.blocks().z;
        f[7] = inside ? Plane::of(voxels.block(v.x, v.y, v.z)) : Plane::zero();
        f[6] = f[7] | from_low<0>(f[7], b[-sx].faces[7]);
        f[5] = f[7] | from_low<1>(f[7], b[-sy].faces[7]);
        f[3] = f[7] | from_low<2>(f[7], b[-sz].faces[7]);
        f[4] = f[6] | from_low<1>(f[6], b[-sy].faces[6]);
        f[2] = f[6] | from_low<2>(f[6], b[-sz].faces[6]);
        f[1] = f[5] | from_low<2>(f[5], b[-sz].faces[5]);
        f[0] = f[4] | from_low<2>(f[4], b[-sz].faces[4]);
      }
    }
  }
}

Imath::V3i CubicalComplex::corner(std::size_t block) const {
  const auto nx = static_cast<std::size_t>(blocks_.x), ny = static_cast<std::size_t>(blocks_.y);
  return (Imath::V3i(static_cast<int>(block % nx), static_cast<int>(block / nx % ny),
                     static_cast<int>(block / (nx * ny))) -
          Imath::V3i(1)) *
         BitBlock::side;
}

bool CubicalComplex::has(Imath::V3i cell, FaceType type) const {
  const BitAddress p = address_of(cell);
  const BitBlock b = data_[p.block].faces[static_cast<std::size_t>(type)].bits();
  return (b.z[static_cast<std::size_t>(p.lane)] >> p.bit & 1) != 0;
}

void CubicalComplex::add(Imath::V3i cell, FaceType type) {
  const BitAddress p = address_of(cell);
  Plane& plane = data_[p.block].faces[static_cast<std::size_t>(type)];
  BitBlock b = plane.bits();
  b.z[static_cast<std::size_t>(p.lane)] |= std::uint64_t{1} << p.bit;
  plane = Plane::of(b);
}

void CubicalComplex::remove(Imath::V3i cell, FaceType type) {
  const BitAddress p = address_of(cell);
  Plane& plane = data_[p.block].faces[static_cast<std::size_t>(type)];
  BitBlock b = plane.bits();
  b.z[static_cast<std::size_t>(p.lane)] &= ~(std::uint64_t{1} << p.bit);
  plane = Plane::of(b);
}

std::size_t CubicalComplex::count(int dim) const {
  std::size_t n = 0;
  for (const ComplexBlock& b : data_) {
    for (FaceType m = 0; m < face_types; ++m) {
      if (dimension(m) == dim) {
        n += static_cast<std::size_t>(b.faces[static_cast<std::size_t>(m)].bits().count());
      }
    }
  }
  return n;
}

std::ptrdiff_t CubicalComplex::euler() const {
  std::ptrdiff_t chi = 0;
  for (int dim = 0; dim <= 3; ++dim) {
    const auto n = static_cast<std::ptrdiff_t>(count(dim));
    chi += dim % 2 == 0 ? n : -n;
  }
  return chi;
}

std::uint64_t closure_faces(const BitGrid3& voxels) {
  const Imath::V3i size = voxels.size(), blocks = voxels.blocks();
  // A face depends on voxels at its cell and before it: process pairs of slices.
  BitGrid3 pair(Imath::V3i(size.x, size.y, 2 * BitBlock::side));
  std::uint64_t faces = 0;
  for (int z = 0; z <= blocks.z; ++z) {
    for (int y = 0; y < blocks.y; ++y) {
      for (int x = 0; x < blocks.x; ++x) {
        pair.block(x, y, 0) = pair.block(x, y, 1);
        pair.block(x, y, 1) = z < blocks.z ? voxels.block(x, y, z) : BitBlock{};
      }
    }
    const CubicalComplex complex(pair);
    const std::size_t begin = complex.index(0, 0, 2), end = complex.index(0, 0, 3);
    for (std::size_t b = begin; b < end; ++b) {
      for (const Plane& p : complex.data()[b].faces) {
        faces += static_cast<std::uint64_t>(p.bits().count());
      }
    }
  }
  return faces;
}

bool CubicalComplex::operator==(const CubicalComplex& o) const {
  if (size_ != o.size_) return false;
  for (std::size_t i = 0; i < data_.size(); ++i) {
    for (std::size_t m = 0; m < face_types; ++m) {
      if ((data_[i].faces[m] ^ o.data_[i].faces[m]).any()) return false;
    }
  }
  return true;
}

}  // namespace lacuna
