#include "analysis/skeleton/label_front.h"

#include <immintrin.h>

#include <algorithm>

#include "analysis/complex/cubical_complex.h"
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

/// All ones in the lanes whose bit is set.
__m256i lanes(unsigned bits) {
  const __m256i bit = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  return _mm256_cmpeq_epi32(_mm256_and_si256(_mm256_set1_epi32(static_cast<int>(bits)), bit), bit);
}

unsigned byte(const BitBlock& bits, int y, int z) {
  return static_cast<unsigned>(bits.z[static_cast<std::size_t>(z)] >> (8 * y)) & 0xffu;
}

}  // namespace

LabelFront::LabelFront(const BitGrid3& domain, Grid3<std::uint32_t>& labels)
    : labels_(labels),
      blocks_(with_ring(domain.size())),
      stride_{1, blocks_.x, std::ptrdiff_t{blocks_.x} * blocks_.y},
      open_(volume(blocks_), Plane::zero()),
      front_(open_.size(), Plane::zero()),
      next_(open_.size(), Plane::zero()),
      asked_(open_.size(), 0) {
  const Imath::V3i n = domain.blocks();
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x)
        open_[index(Imath::V3i(x, y, z) * BitBlock::side)] = Plane::of(domain.block(x, y, z));
}

std::uint64_t LabelFront::bytes(Imath::V3i size) {
  return volume(with_ring(size)) * (3 * sizeof(Plane) + 3 * sizeof(std::uint32_t));
}

Imath::V3i LabelFront::corner(std::size_t block) const {
  const auto b = static_cast<std::ptrdiff_t>(block);
  return (Imath::V3i(static_cast<int>(b % stride_[1]),
                     static_cast<int>(b % stride_[2] / stride_[1]),
                     static_cast<int>(b / stride_[2])) -
          Imath::V3i(1)) *
         BitBlock::side;
}

void LabelFront::start(Imath::V3i voxel, std::uint32_t label) {
  if (!in_grid(voxel, labels_.size())) return;
  const std::size_t block = index(voxel);
  BitBlock bits;
  bits.z[static_cast<std::size_t>(voxel.z & 7)] = std::uint64_t{1}
                                                  << ((voxel.y & 7) * 8 + (voxel.x & 7));
  const Plane bit = Plane::of(bits);
  if (!(open_[block] & bit).any()) return;
  open_[block] &= ~bit;
  if (!front_[block].any()) active_.push_back(static_cast<std::uint32_t>(block));
  front_[block] |= bit;
  labels_(voxel) = label;
}

void LabelFront::find_candidates() {
  ++steps_;
  candidates_.clear();
  const auto ask = [&](std::size_t block) {
    if (asked_[block] == steps_) return;
    asked_[block] = steps_;
    if (open_[block].any()) candidates_.push_back(static_cast<std::uint32_t>(block));
  };
  for (const std::uint32_t block : active_) {
    ask(block);
    for (const std::ptrdiff_t s : stride_) {
      ask(static_cast<std::size_t>(block - s));
      ask(static_cast<std::size_t>(block + s));
    }
  }
}

void LabelFront::run(const ThreadPool& pool) {
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
}

bool LabelFront::step(std::size_t block) {
  const Plane own = front_[block];
  const auto at = static_cast<std::ptrdiff_t>(block);
  const auto front = [&](std::ptrdiff_t offset) {
    return front_[static_cast<std::size_t>(at + offset)];
  };
  const Plane open = open_[block];
  const std::array<Plane, 6> from{
      from_low<0>(own, front(-1)) & open,          from_high<0>(own, front(1)) & open,
      from_low<1>(own, front(-stride_[1])) & open, from_high<1>(own, front(stride_[1])) & open,
      from_low<2>(own, front(-stride_[2])) & open, from_high<2>(own, front(stride_[2])) & open};
  const Plane next = from[0] | from[1] | from[2] | from[3] | from[4] | from[5];
  if (!next.any()) return false;
  hand_on(block, from, next);
  next_[block] = next;
  open_[block] = open & ~next;
  return true;
}

void LabelFront::hand_on(std::size_t block, const std::array<Plane, 6>& from, const Plane& next) {
  const Imath::V3i low = corner(block);
  const auto width = static_cast<std::ptrdiff_t>(labels_.size().x);
  const std::ptrdiff_t plane = width * labels_.size().y;
  const std::array<std::ptrdiff_t, 6> offset{-1, 1, -width, width, -plane, plane};
  const BitBlock reached = next.bits();
  std::array<BitBlock, 6> source;
  for (std::size_t d = 0; d < 6; ++d) source[d] = from[d].bits();
  const __m256i none = _mm256_set1_epi32(-1);
  for (int z = 0; z < BitBlock::side; ++z) {
    if (reached.z[static_cast<std::size_t>(z)] == 0) continue;
    for (int y = 0; y < BitBlock::side; ++y) {
      const unsigned here = byte(reached, y, z);
      if (here == 0) continue;
      std::uint32_t* row = labels_.row(low.y + y, low.z + z) + low.x;
      __m256i label = none;
      // Only lanes of the step before are read: no other thread writes them, and they lie in the
      // grid.
      for (std::size_t d = 0; d < 6; ++d) {
        const unsigned bits = byte(source[d], y, z);
        const __m256i mask = lanes(bits);
        const std::uint32_t* p = bits != 0 ? row + offset[d] : row;
        const __m256i read = _mm256_maskload_epi32(reinterpret_cast<const int*>(p), mask);
        label = _mm256_min_epu32(label, _mm256_or_si256(read, _mm256_xor_si256(mask, none)));
      }
      _mm256_maskstore_epi32(reinterpret_cast<int*>(row), lanes(here), label);
    }
  }
}

std::vector<Imath::V3i> LabelFront::unreached() const {
  std::vector<Imath::V3i> voxels;
  for (std::size_t b = 0; b < open_.size(); ++b)
    if (open_[b].any())
      for_each_bit(open_[b],
                   [&](int position) { voxels.push_back(corner(b) + cell_of(position)); });
  return voxels;
}

}  // namespace lacuna
