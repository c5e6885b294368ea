#include "analysis/complex/pierce.h"

#include <algorithm>
#include <unordered_map>

#include "analysis/complex/complex_components.h"
#include "analysis/geometry/bits.h"
#include "analysis/geometry/disjoint_sets.h"

namespace lacuna {
namespace {

int normal_axis(FaceType square) { return square == 6 ? 0 : square == 5 ? 1 : 2; }

/// The voxel on the other side of a square, opposite the one at its cell.
Imath::V3i voxel_before(const Square& s) {
  Imath::V3i cell = s.cell;
  cell[normal_axis(s.type)] -= 1;
  return cell;
}

/// The squares of one block in a slice of cells, 8 x 8 bits per type.
struct SquareBits {
  int x;  // the block's first cell
  std::uint64_t xy, xz, yz;
};

template <class F>
void visit_row(const std::vector<SquareBits>& blocks, int y, int z, const F& visit) {
  const int shift = 8 * (y & 7);
  for (const SquareBits& b : blocks) {
    for_each_bit((b.xy | b.xz | b.yz) >> shift & 0xff, [&](int bit) {
      const Imath::V3i cell(b.x + bit, y, z);
      if ((b.xy >> (shift + bit) & 1) != 0) visit(Square{cell, 3});
      if ((b.xz >> (shift + bit) & 1) != 0) visit(Square{cell, 5});
      if ((b.yz >> (shift + bit) & 1) != 0) visit(Square{cell, 6});
    });
  }
}

/// Visits the squares of a slice of blocks across z by cell (x fastest), then type: not by block,
/// so that the results commute with translations of the grid.
template <class F>
void for_each_square(const CubicalComplex& complex, int slice, const F& visit) {
  const Imath::V3i n = complex.blocks();
  std::vector<SquareBits> blocks;
  for (int z = 8 * slice; z < 8 * (slice + 1); ++z) {
    for (int by = 1; by < n.y - 1; ++by) {
      blocks.clear();
      for (int bx = 1; bx < n.x - 1; ++bx) {
        const auto& f = complex.data()[complex.index(bx, by, (z >> 3) + 1)].faces;
        const auto lane = static_cast<std::size_t>(z & 7);
        const SquareBits b{8 * (bx - 1), f[3].bits().z[lane], f[5].bits().z[lane],
                           f[6].bits().z[lane]};
        if ((b.xy | b.xz | b.yz) != 0) blocks.push_back(b);
      }
      if (blocks.empty()) continue;
      for (int y = 8 * (by - 1); y < 8 * by; ++y) visit_row(blocks, y, z, visit);
    }
  }
}

/// The values that `look(square, add)` adds, ordered by descending distance of the squares to the
/// scene, then by cell and type.
template <class T, class Look>
std::vector<T> farthest_first(const CubicalComplex& complex, const Grid3<std::uint16_t>& distance,
                              const ThreadPool* pool, const Look& look) {
  using ByDistance = std::vector<std::vector<T>>;
  std::vector<ByDistance> slices(static_cast<std::size_t>(complex.blocks().z - 2));
  const auto at = [&](Imath::V3i v) {
    return in_grid(v, distance.size()) ? std::size_t{distance(v)} : 0;
  };
  const auto gather = [&](int slice) {
    ByDistance& found = slices[static_cast<std::size_t>(slice)];
    for_each_square(complex, slice, [&](const Square& s) {
      look(s, [&](const T& thing) {
        const std::size_t d = std::max(at(s.cell), at(voxel_before(s)));
        if (d >= found.size()) found.resize(d + 1);
        found[d].push_back(thing);
      });
    });
  };
  const int n = static_cast<int>(slices.size());
  if (pool != nullptr) {
    pool->for_each(n, gather);
  } else {
    for (int slice = 0; slice < n; ++slice) gather(slice);
  }
  std::size_t distances = 0;
  for (const ByDistance& found : slices) distances = std::max(distances, found.size());
  std::vector<T> all;
  for (std::size_t d = distances; d-- > 0;) {
    for (const ByDistance& found : slices) {
      if (d < found.size()) all.insert(all.end(), found[d].begin(), found[d].end());
    }
  }
  return all;
}

/// The squares of a spanning forest, whose nodes are the components of the complement.
std::vector<Square> between_components(const CubicalComplex& thin,
                                       const Grid3<std::uint16_t>& distance,
                                       const ThreadPool* pool) {
  struct Edge {
    Square square;
    std::uint32_t a, b;
  };
  const ComplementComponents complement =
      pool != nullptr ? ComplementComponents(thin, *pool) : ComplementComponents(thin);
  std::vector<Square> chosen;
  if (complement.count() == 1) return chosen;
  const auto edges = farthest_first<Edge>(thin, distance, pool, [&](const Square& s, auto add) {
    const std::uint32_t a = complement.of(s.cell), b = complement.of(voxel_before(s));
    if (a != b) add({s, a, b});
  });
  DisjointSets joined(complement.count());
  for (const Edge& e : edges) {
    if (joined.join(e.a, e.b)) chosen.push_back(e.square);
  }
  return chosen;
}

/// One square of each part connected through edges.
std::vector<Square> one_of_each_part(const CubicalComplex& thin,
                                     const Grid3<std::uint16_t>& distance, const ThreadPool* pool) {
  const auto all =
      farthest_first<Square>(thin, distance, pool, [](const Square& s, auto add) { add(s); });
  const Imath::V3i size = thin.size();
  DisjointSets parts(all.size());
  std::unordered_map<std::uint64_t, std::uint32_t> square_at_edge;
  // The grid of cells has one more than voxels along each axis.
  const std::uint64_t w = static_cast<std::uint64_t>(size.x) + 1,
                      h = static_cast<std::uint64_t>(size.y) + 1;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const auto& [cell, type] = all[i];
    for (int axis = 0; axis < 3; ++axis) {  // the two edges of the square along this axis
      if ((type >> axis & 1) == 0) continue;
      const int other = 3 - axis - normal_axis(type);
      for (int far = 0; far < 2; ++far) {
        Imath::V3i c = cell;
        c[other] += far;
        const std::uint64_t edge =
            ((static_cast<std::uint64_t>(c.z) * h + static_cast<std::uint64_t>(c.y)) * w +
             static_cast<std::uint64_t>(c.x)) *
                3 +
            static_cast<std::uint64_t>(axis);
        const auto [it, added] = square_at_edge.try_emplace(edge, i);
        if (!added) parts.join(it->second, i);
      }
    }
  }
  std::vector<Square> chosen;  // the end of a part is its first square: the farthest
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    if (parts.end_of(i) == i) chosen.push_back(all[i]);
  }
  return chosen;
}

}  // namespace

std::vector<Square> squares_to_pierce(const CubicalComplex& thin,
                                      const Grid3<std::uint16_t>& distance,
                                      const ThreadPool* pool) {
  std::vector<Square> chosen = between_components(thin, distance, pool);
  return chosen.empty() ? one_of_each_part(thin, distance, pool) : chosen;
}

}  // namespace lacuna
