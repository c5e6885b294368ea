#include "analysis/complex/pierce.h"

#include <algorithm>
#include <tuple>
#include <unordered_map>

#include "analysis/complex/complex_components.h"
#include "analysis/geometry/disjoint_sets.h"

namespace lacuna {
namespace {

struct Candidate {
  Square square;
  int distance;
};

int normal_axis(FaceType square) { return square == 6 ? 0 : square == 5 ? 1 : 2; }

Imath::V3i before(Imath::V3i cell, int axis) {
  cell[axis] -= 1;
  return cell;
}

/// All squares, those farthest from the scene first, equal ones by cell (x fastest) and type: not
/// in the order of blocks, so that the result commutes with translations of the grid.
std::vector<Candidate> candidates(const CubicalComplex& thin,
                                  const Grid3<std::uint16_t>& distance) {
  std::vector<Candidate> all;
  const auto at = [&](Imath::V3i v) {
    return in_grid(v, distance.size()) ? static_cast<int>(distance(v)) : 0;
  };
  for (std::size_t block = 0; block < thin.block_count(); ++block) {
    for (const FaceType type : {3, 5, 6}) {
      for_each_bit(thin.data()[block].faces[static_cast<std::size_t>(type)], [&](int position) {
        const Imath::V3i cell = thin.corner(block) + cell_of(position);
        const int d = std::max(at(cell), at(before(cell, normal_axis(type))));
        all.push_back({{cell, type}, d});
      });
    }
  }
  std::sort(all.begin(), all.end(), [](const Candidate& a, const Candidate& b) {
    const auto order = [](const Candidate& c) {
      const auto& [cell, type] = c.square;
      return std::tuple(-c.distance, cell.z, cell.y, cell.x, type);
    };
    return order(a) < order(b);
  });
  return all;
}

/// One square of each part that hangs together through edges.
std::vector<Square> one_of_each_part(const std::vector<Candidate>& all, Imath::V3i size) {
  DisjointSets parts(all.size());
  std::unordered_map<std::uint64_t, std::uint32_t> square_at_edge;
  // The grid of cells, one more than voxels along each axis.
  const std::uint64_t w = static_cast<std::uint64_t>(size.x) + 1,
                      h = static_cast<std::uint64_t>(size.y) + 1;
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const auto& [cell, type] = all[i].square;
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
    if (parts.end_of(i) == i) chosen.push_back(all[i].square);
  }
  return chosen;
}

}  // namespace

std::vector<Square> squares_to_pierce(const CubicalComplex& thin,
                                      const Grid3<std::uint16_t>& distance) {
  const std::vector<Candidate> all = candidates(thin, distance);
  if (all.empty()) return {};
  const ComplementComponents complement(thin);
  DisjointSets joined(complement.count());
  std::vector<Square> chosen;
  for (const auto& [square, d] : all) {
    const Imath::V3i other = before(square.cell, normal_axis(square.type));
    if (joined.join(complement.of(square.cell), complement.of(other))) chosen.push_back(square);
  }
  return chosen.empty() ? one_of_each_part(all, thin.size()) : chosen;
}

}  // namespace lacuna
