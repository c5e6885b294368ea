#include "analysis/skeleton/wavefront.h"

#include <algorithm>

#include "analysis/complex/cubical_complex.h"
#include "analysis/geometry/bits.h"
#include "analysis/skeleton/graph.h"
#include "analysis/space/sweep.h"

namespace lacuna {
namespace {

Imath::V3i with_ring(Imath::V3i size) {
  return (size + Imath::V3i(BitBlock::side - 1)) / BitBlock::side + Imath::V3i(2);
}
std::size_t volume(Imath::V3i n) {
  return static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) *
         static_cast<std::size_t>(n.z);
}
Plane bit_of(Imath::V3i voxel) {
  BitBlock bits;
  bits.z[static_cast<std::size_t>(voxel.z & 7)] = std::uint64_t{1}
                                                  << ((voxel.y & 7) * 8 + (voxel.x & 7));
  return Plane::of(bits);
}

}  // namespace

Wavefront::Wavefront(const BitGrid3& domain, Grid3<std::uint32_t>& labels)
    : labels_(labels),
      ringed_(with_ring(domain.size())),
      stride_{1, ringed_.x, std::ptrdiff_t{ringed_.x} * ringed_.y},
      blocks_(volume(ringed_)),
      front_(blocks_.size(), Plane::zero()),
      next_(blocks_.size(), Plane::zero()),
      asked_(blocks_.size(), 0) {
  const Imath::V3i n = domain.blocks();
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x)
        blocks_[index(Imath::V3i(x, y, z) * BitBlock::side)].open =
            Plane::of(domain.block(x, y, z));
}

std::uint64_t Wavefront::bytes(Imath::V3i size) {
  return volume(with_ring(size)) * (sizeof(Block) + 2 * sizeof(Plane) + 3 * sizeof(std::uint32_t));
}

Imath::V3i Wavefront::corner(std::size_t block) const {
  const auto b = static_cast<std::ptrdiff_t>(block);
  return (Imath::V3i(static_cast<int>(b % stride_[1]),
                     static_cast<int>(b % stride_[2] / stride_[1]),
                     static_cast<int>(b / stride_[2])) -
          Imath::V3i(1)) *
         BitBlock::side;
}

unsigned Wavefront::from(Imath::V3i voxel) const {
  const Block& block = blocks_[index(voxel)];
  const auto lane = static_cast<std::size_t>(voxel.z & 7);
  const int bit = (voxel.y & 7) * 8 + (voxel.x & 7);
  unsigned code = 0;
  for (unsigned i = 0; i < 3; ++i) {
    code |= static_cast<unsigned>(block.from[i].z[lane] >> bit & 1) << i;
  }
  return code;
}

void Wavefront::start(Imath::V3i voxel, std::uint32_t label) {
  if (!in_grid(voxel, labels_.size())) return;
  const std::size_t b = index(voxel);
  Block& block = blocks_[b];
  const Plane bit = bit_of(voxel);
  if (!(block.open & bit).any()) return;
  block.open &= ~bit;
  for (BitBlock& bits : block.from) bits = (Plane::of(bits) | bit).bits();
  if (!front_[b].any()) active_.push_back(static_cast<std::uint32_t>(b));
  front_[b] |= bit;
  labels_(voxel) = label;
}

void Wavefront::find_candidates() {
  ++steps_;
  candidates_.clear();
  const auto ask = [&](std::size_t block) {
    if (asked_[block] == steps_) return;
    asked_[block] = steps_;
    if (blocks_[block].open.any()) candidates_.push_back(static_cast<std::uint32_t>(block));
  };
  for (const std::uint32_t block : active_) {
    ask(block);
    for (const std::ptrdiff_t s : stride_) {
      ask(static_cast<std::size_t>(block - s));
      ask(static_cast<std::size_t>(block + s));
    }
  }
}

void Wavefront::run(const ThreadPool& pool) {
  constexpr std::size_t at_a_time = 32;
  std::vector<char> reached;
  while (!active_.empty()) {
    find_candidates();
    reached.assign(candidates_.size(), 0);
    const std::size_t parts = (candidates_.size() + at_a_time - 1) / at_a_time;
    const auto work = [&](int part) {
      const std::size_t from = static_cast<std::size_t>(part) * at_a_time;
      for (std::size_t i = from; i < std::min(from + at_a_time, candidates_.size()); ++i)
        reached[i] = step(candidates_[i]);
    };
    run_parallel(pool, static_cast<int>(parts), work);
    for (const std::uint32_t block : active_) front_[block] = Plane::zero();
    front_.swap(next_);
    active_.clear();
    for (std::size_t i = 0; i < candidates_.size(); ++i)
      if (reached[i]) active_.push_back(candidates_[i]);
  }
  run_parallel(pool, ringed_.z, [&](int slice) { label_across_planes(slice); });
  run_parallel(pool, labels_.size().z, [&](int z) { label_plane(z); });
}

bool Wavefront::step(std::size_t block) {
  const Plane own = front_[block];
  const auto at = static_cast<std::ptrdiff_t>(block);
  const auto front = [&](std::ptrdiff_t offset) {
    return front_[static_cast<std::size_t>(at + offset)];
  };
  Block& b = blocks_[block];
  const std::array<Plane, 6> reach{
      from_low<0>(own, front(-1)),          from_high<0>(own, front(1)),
      from_low<1>(own, front(-stride_[1])), from_high<1>(own, front(stride_[1])),
      from_low<2>(own, front(-stride_[2])), from_high<2>(own, front(stride_[2]))};
  Plane left = b.open;
  std::array<Plane, 3> from{Plane::zero(), Plane::zero(), Plane::zero()};
  for (unsigned d = 0; d < 6; ++d) {
    const Plane taken = left & reach[d];
    for (unsigned i = 0; i < 3; ++i)
      if (((d + 1) >> i & 1) != 0) from[i] |= taken;
    left &= ~taken;
  }
  const Plane next = b.open & ~left;
  if (!next.any()) return false;
  next_[block] = next;
  b.open = left;
  for (std::size_t i = 0; i < 3; ++i) b.from[i] = (Plane::of(b.from[i]) | from[i]).bits();
  return true;
}

/// Labels the path from a voxel back to the first labelled one. Paths merge: several threads may
/// label a voxel, with the same label.
void Wavefront::trace(Imath::V3i voxel, std::vector<Imath::V3i>& way) {
  way.clear();
  std::uint32_t label = no_node;
  while ((label = label_at(voxel).load(std::memory_order_relaxed)) == no_node) {
    way.push_back(voxel);
    const int code = static_cast<int>(from(voxel)) - 1;
    voxel[code / 2] += code % 2 == 0 ? -1 : 1;
  }
  for (const Imath::V3i& v : way) label_at(v).store(label, std::memory_order_relaxed);
}

/// Labels the voxels that were reached along z, of one slice of blocks across z.
void Wavefront::label_across_planes(int slice) {
  std::vector<Imath::V3i> way;
  const auto blocks = static_cast<std::size_t>(stride_[2]);
  const std::size_t begin = static_cast<std::size_t>(slice) * blocks;
  for (std::size_t b = begin; b < begin + blocks; ++b) {
    const auto& from = blocks_[b].from;
    const Plane along_z = Plane::of(from[2]) & (Plane::of(from[0]) ^ Plane::of(from[1]));
    if (along_z.any())
      for_each_bit(along_z, [&](int position) { trace(corner(b) + cell_of(position), way); });
  }
}

/// Labels the voxels reached along y, whose paths stay in the plane, then those along x.
void Wavefront::label_plane(int z) {
  std::vector<Imath::V3i> way;
  const auto lane = static_cast<std::size_t>(z & 7);
  const Imath::V3i n = labels_.size();
  for (int y = 0; y < n.y; y += BitBlock::side)
    for (int x = 0; x < n.x; x += BitBlock::side) {
      const auto& from = blocks_[index({x, y, z})].from;
      const std::uint64_t low = from[0].z[lane], mid = from[1].z[lane], high = from[2].z[lane];
      for_each_bit((low & mid & ~high) | (~low & ~mid & high), [&](int bit) {
        trace({x + (bit & 7), y + (bit >> 3), z}, way);
      });
    }
  for (int y = 0; y < n.y; ++y) label_row(y, z);
}

void Wavefront::label_row(int y, int z) {
  std::uint32_t* row = labels_.row(y, z);
  const std::size_t first = index({0, y, z});
  const auto lane = static_cast<std::size_t>(z & 7);
  const int shift = (y & 7) * 8, blocks = ringed_.x - 2;
  const auto code_bits = [&](int bx, std::size_t which) {
    const Block& block = blocks_[first + static_cast<std::size_t>(bx)];
    const auto byte = [&](std::size_t i) {
      return static_cast<unsigned>(block.from[i].z[lane] >> shift) & 0xffu;
    };
    return byte(which) & ~byte(1 - which) & ~byte(2);
  };
  for (int bx = 0; bx < blocks; ++bx)
    for_each_bit(code_bits(bx, 0), [&](int i) { row[8 * bx + i] = row[8 * bx + i - 1]; });
  for (int bx = blocks - 1; bx >= 0; --bx)
    for_each_bit_descending(code_bits(bx, 1),
                            [&](int i) { row[8 * bx + i] = row[8 * bx + i + 1]; });
}

std::vector<Imath::V3i> Wavefront::unreached() const {
  std::vector<Imath::V3i> voxels;
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    if (blocks_[b].open.any())
      for_each_bit(blocks_[b].open,
                   [&](int position) { voxels.push_back(corner(b) + cell_of(position)); });
  return voxels;
}

}  // namespace lacuna
