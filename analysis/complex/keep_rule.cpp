#include "analysis/complex/keep_rule.h"

#include <algorithm>

namespace lacuna {
namespace {

Plane at_position(int position) {
  BitBlock b;
  b.z[static_cast<std::size_t>(position >> 6)] = std::uint64_t{1} << (position & 63);
  return Plane::of(b);
}

}  // namespace

KeepRule::KeepRule(const CubicalComplex& complex, const SpaceMaps& maps, KeptEdges& kept)
    : complex_(complex),
      maps_(maps),
      kept_(kept),
      alive_(complex.block_count()),
      births_(complex.block_count()) {}

void KeepRule::edges(int date, std::size_t block, const std::array<Plane, 3>& present,
                     const std::array<Plane, 3>& facets) {
  auto& alive = alive_[block];
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const Plane died = alive[a] & ~present[a], born = facets[a] & ~alive[a];
    const auto edge = [axis](int position) {
      return static_cast<std::uint16_t>(position + 512 * axis);
    };
    if (died.any()) {
      for_each_bit(died, [&](int position) {
        const int birth = take_birth(block, edge(position));
        if (is_kept(block, axis, position)) return;  // after piercing, nearly all are
        if (holds(complex_.corner(block) + cell_of(position), axis, birth, date)) {
          const std::lock_guard lock(keeping_);
          kept_.add(block, axis, at_position(position));
        }
      });
    }
    if (born.any()) {
      for_each_bit(born, [&](int position) {
        births_[block].push_back({edge(position), static_cast<std::uint32_t>(date)});
      });
    }
    alive[a] = facets[a];
  }
}

bool KeepRule::is_kept(std::size_t block, int axis, int position) {
  const std::lock_guard lock(keeping_);
  return (kept_.of(block).edges[static_cast<std::size_t>(axis)] & at_position(position)).any();
}

void KeepRule::finish() {
  for (std::size_t block = 0; block < alive_.size(); ++block) {
    for (int axis = 0; axis < 3; ++axis) {
      const Plane& forever = alive_[block][static_cast<std::size_t>(axis)];
      if (forever.any()) kept_.add(block, axis, forever);
    }
  }
}

int KeepRule::take_birth(std::size_t block, std::uint16_t edge) {
  auto& births = births_[block];
  const auto it =
      std::find_if(births.begin(), births.end(), [edge](const Birth& b) { return b.edge == edge; });
  const int date = static_cast<int>(it->date);
  *it = births.back();
  births.pop_back();
  return date;
}

bool KeepRule::holds(Imath::V3i cell, int axis, int birth, int death) {
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  std::array<Imath::V3i, 4> voxels;
  std::array<int, 4> distance{};
  for (int i = 0; i < 4; ++i) {
    Imath::V3i v = cell;
    v[b] -= i & 1;
    v[c] -= i >> 1;
    const auto k = static_cast<std::size_t>(i);
    voxels[k] = v;
    distance[k] = in_grid(v, maps_.distance.size()) ? maps_.distance(v) : 0;
  }
  const int d = *std::max_element(distance.begin(), distance.end());
  const int lifespan = death - birth;
  if (lifespan <= birth - d) return false;          // decenterness is never below 0
  const int too_decentered = lifespan - birth + d;  // > 0
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    if (distance[i] == 0) continue;
    ++openings_asked_;
    if (maps_.opening_reaches(voxels[i], distance[i] + too_decentered)) return false;
  }
  return true;
}

}  // namespace lacuna
