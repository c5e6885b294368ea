#include "analysis/space/opening_query.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include "analysis/space/sweep.h"

// Branch and bound: a block can hold a larger ball over x only if its largest D_1 passes both the
// best radius found so far and the distance from x to the block.

namespace lacuna {

namespace {

constexpr int side = 8;  // of a block in voxels, and of a tile in blocks

Imath::V3i coarse(Imath::V3i size) { return (size + Imath::V3i(side - 1)) / side; }

/// The largest value of each cube of side^3, plane by plane.
Grid3<std::uint16_t> cube_maxima(const Grid3<std::uint16_t>& fine, const ThreadPool& pool) {
  const Imath::V3i size = fine.size();
  Grid3<std::uint16_t> maxima(coarse(size));
  run_parallel(pool, maxima.size().z, [&](int bz) {
    std::vector<std::uint16_t> row(static_cast<std::size_t>(maxima.size().x) * side);
    for (int by = 0; by < maxima.size().y; ++by) {
      std::fill(row.begin(), row.end(), 0);
      for (int z = side * bz; z < std::min(side * (bz + 1), size.z); ++z)
        for (int y = side * by; y < std::min(side * (by + 1), size.y); ++y) {
          const std::uint16_t* values = fine.row(y, z);
          for (std::size_t x = 0; x < static_cast<std::size_t>(size.x); ++x)
            row[x] = std::max(row[x], values[x]);
        }
      for (int bx = 0; bx < maxima.size().x; ++bx) {
        const auto begin = row.begin() + side * bx;
        maxima(bx, by, bz) = *std::max_element(begin, begin + side);
      }
    }
  });
  return maxima;
}

/// The L1 distance from x to the cube [low, low + length).
int distance_to_cube(Imath::V3i x, Imath::V3i low, int length) {
  int sum = 0;
  for (int a = 0; a < 3; ++a) sum += std::max({low[a] - x[a], 0, x[a] - (low[a] + length - 1)});
  return sum;
}

int l1(Imath::V3i v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

}  // namespace

struct OpeningQuery::Search {
  const OpeningQuery& query;
  Imath::V3i x;
  int best;
  int enough = 65535;  // the search may end once `best` reaches this

  bool worth(int largest, int distance) const {
    return largest > best && distance < largest && best < enough;
  }

  /// Ascends D_1 while its balls contain x.
  void climb() {
    const Grid3<std::uint16_t>& d = *query.l1_;
    for (Imath::V3i at = x;;) {
      Imath::V3i next = at;
      for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
          for (int dx = -1; dx <= 1; ++dx) {
            const Imath::V3i v = at + Imath::V3i(dx, y, z);
            if (in_grid(v, d.size()) && d(v) > best && l1(v - x) < d(v)) {
              best = d(v);
              next = v;
            }
          }
      if (next == at || best >= enough) return;
      at = next;
    }
  }

  void in_grid_of_tiles() {
    const Imath::V3i size = query.tiles_.size();
    Imath::V3i t;
    for (t.z = 0; t.z < size.z; ++t.z)
      for (t.y = 0; t.y < size.y; ++t.y)
        for (t.x = 0; t.x < size.x; ++t.x)
          if (worth(query.tiles_(t), distance_to_cube(x, t * side * side, side * side))) in_tile(t);
  }

  void in_tile(Imath::V3i t) {
    const Grid3<std::uint16_t>& blocks = query.blocks_;
    Imath::V3i end = (t + Imath::V3i(1)) * side, b;
    for (int a = 0; a < 3; ++a) end[a] = std::min(end[a], blocks.size()[a]);
    for (b.z = t.z * side; b.z < end.z; ++b.z)
      for (b.y = t.y * side; b.y < end.y; ++b.y)
        for (b.x = t.x * side; b.x < end.x; ++b.x)
          if (worth(blocks(b), distance_to_cube(x, b * side, side))) in_block(b);
  }

  void in_block(Imath::V3i b) {
    const Grid3<std::uint16_t>& d = *query.l1_;
    const Imath::V3i low = b * side;
    Imath::V3i end = low + Imath::V3i(side);
    for (int a = 0; a < 3; ++a) end[a] = std::min(end[a], d.size()[a]);
    for (int z = low.z; z < end.z; ++z)
      for (int y = low.y; y < end.y; ++y) {
        const int across = std::abs(y - x.y) + std::abs(z - x.z);
        const std::uint16_t* row = d.row(y, z);
        for (int i = low.x; i < end.x; ++i)
          if (row[i] > best && across + std::abs(i - x.x) < row[i]) best = row[i];
      }
  }
};

OpeningQuery::OpeningQuery(const Grid3<std::uint16_t>& l1, const ThreadPool& pool)
    : l1_(&l1), blocks_(cube_maxima(l1, pool)), tiles_(cube_maxima(blocks_, pool)) {}

std::uint16_t OpeningQuery::operator()(Imath::V3i voxel) const {
  const int own = (*l1_)(voxel);
  if (own == 0) return 0;
  Search search{*this, voxel, own};
  search.climb();
  search.in_grid_of_tiles();
  return static_cast<std::uint16_t>(search.best);
}

bool OpeningQuery::reaches(Imath::V3i voxel, int radius) const {
  const int own = (*l1_)(voxel);
  if (own == 0 || own >= radius) return own != 0;
  Search search{*this, voxel, own, radius};
  search.climb();
  if (search.best < radius) {
    search.best = radius - 1;
    search.in_grid_of_tiles();
  }
  return search.best >= radius;
}

}  // namespace lacuna
