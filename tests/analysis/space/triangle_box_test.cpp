#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <tuple>

#include "analysis/space/triangle_box.h"
#include "tests/analysis/space/soups_and_grids.h"

namespace lacuna {
namespace {

using Imath::V3d;
using Imath::V3i;
using Corners = std::array<V3d, 3>;
using Cells = std::set<std::tuple<int, int, int>>;

constexpr int cells = 9;     // along each side of the clip box
constexpr int fine = 16;     // lattice positions along a cell
using Exact = std::int64_t;  // products of three positions below 2^8
using V3e = std::array<Exact, 3>;

V3e cross(const V3e& a, const V3e& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Exact dot(const V3e& a, const V3e& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Separating axes in whole numbers: corners and cell in lattice positions.
bool meets_exactly(const std::array<V3e, 3>& t, V3i cell) {
  std::vector<V3e> axes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  std::array<V3e, 3> edges;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t a = 0; a < 3; ++a) edges[i][a] = t[(i + 1) % 3][a] - t[i][a];
  axes.push_back(cross(edges[0], edges[1]));
  for (const V3e& e : edges)
    for (std::size_t a = 0; a < 3; ++a) axes.push_back(cross(e, axes[a]));
  for (const V3e& axis : axes) {
    const auto of_triangle = std::minmax({dot(axis, t[0]), dot(axis, t[1]), dot(axis, t[2])});
    Exact low = 0, high = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const Exact from = axis[a] * fine * cell[static_cast<int>(a)], to = from + axis[a] * fine;
      low += std::min(from, to);
      high += std::max(from, to);
    }
    if (of_triangle.first > high || of_triangle.second < low) return false;
  }
  return true;
}

/// What is left of the triangle within the cell grown by `margin`, half-space by half-space:
/// whether there is anything. Knows nothing of separating axes.
bool meets_by_clipping(const Corners& corners, V3i cell, double margin) {
  std::vector<V3d> polygon(corners.begin(), corners.end());
  for (int a = 0; a < 3; ++a)
    for (const double sign : {1.0, -1.0}) {
      const double bound = sign > 0 ? cell[a] + 1 + margin : -cell[a] + margin;
      const auto beyond = [&](const V3d& p) { return sign * p[a] - bound; };
      std::vector<V3d> kept;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const V3d &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        if (beyond(p) <= 0) kept.push_back(p);
        if ((beyond(p) < 0 && beyond(q) > 0) || (beyond(p) > 0 && beyond(q) < 0))
          kept.push_back(p + (q - p) * (beyond(p) / (beyond(p) - beyond(q))));
      }
      polygon = kept;
      if (polygon.empty()) return false;
    }
  return true;
}

Cells cells_of(const Corners& corners, const CellBox& clip) {
  Cells found;
  TriangleBox(corners).for_each_line(clip, [&](int axis, V3i cell, int count) {
    for (; count > 0; --count, ++cell[axis])
      EXPECT_TRUE(found.insert({cell.x, cell.y, cell.z}).second) << cell << " came twice";
  });
  return found;
}

template <class Meets>
void for_each_cell(const CellBox& box, Meets&& visit) {
  V3i c;
  for (c.z = box.low.z; c.z < box.high.z; ++c.z)
    for (c.y = box.low.y; c.y < box.high.y; ++c.y)
      for (c.x = box.low.x; c.x < box.high.x; ++c.x) visit(c);
}

/// Corners on the lattice: cells that only touch the triangle are frequent.
TEST(TriangleBox, IsTheExactTestOnALattice) {
  std::mt19937 rng(31);
  const CellBox all{V3i(0), V3i(cells)};
  for (int round = 0; round < 3000; ++round) {
    // From whole cells only to all lattice positions; every third triangle is degenerate.
    const int step = std::array{fine, fine / 2, 1}[static_cast<std::size_t>(round % 3)];
    std::uniform_int_distribution<int> any(0, cells * fine / step);
    std::array<V3e, 3> exact;
    for (V3e& corner : exact)
      for (Exact& x : corner) x = any(rng) * step;
    if (round % 9 == 3) exact[1] = exact[0];
    if (round % 9 == 4) exact[1] = exact[2] = exact[0];
    if (round % 9 == 5)
      for (std::size_t a = 0; a < 3; ++a) exact[2][a] = 2 * exact[1][a] - exact[0][a];
    if (round % 9 == 6) exact[0][2] = exact[1][2] = exact[2][2];
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t a = 0; a < 3; ++a)
        corners[i][static_cast<int>(a)] = static_cast<double>(exact[i][a]) / fine;
    const Cells found = cells_of(corners, all);
    for_each_cell(all, [&](V3i c) {
      ASSERT_EQ(found.contains({c.x, c.y, c.z}), meets_exactly(exact, c))
          << "cell " << c << " and " << corners[0] << corners[1] << corners[2];
    });
  }
}

/// Any corners, and slivers: nothing that is met is missed, and little else is found.
TEST(TriangleBox, MissesNothingAndFindsLittleElse) {
  std::mt19937 rng(32);
  const CellBox all{V3i(0), V3i(cells)};
  std::uniform_real_distribution<double> any(-1, cells + 1);
  std::normal_distribution<double> g;
  for (int round = 0; round < 3000; ++round) {
    Corners corners;
    for (V3d& c : corners) c = V3d(any(rng), any(rng), any(rng));
    const double width = std::pow(10.0, -(round % 13));  // down to 1e-12 of a cell
    if (round % 2 == 1)
      corners[2] = corners[0] + (corners[1] - corners[0]) * (any(rng) / cells) +
                   V3d(g(rng), g(rng), g(rng)) * width;
    const Cells found = cells_of(corners, all);
    for_each_cell(all, [&](V3i c) {
      const bool is_found = found.contains({c.x, c.y, c.z});
      if (meets_by_clipping(corners, c, 0)) {
        ASSERT_TRUE(is_found) << c << " is missed";
      }
      if (is_found) {
        ASSERT_TRUE(meets_by_clipping(corners, c, 1e-6)) << c << " is not met";
      }
    });
  }
}

TEST(TriangleBox, OfPartsIsThatOfTheWhole) {
  std::mt19937 rng(33);
  std::uniform_real_distribution<double> any(0, cells);
  for (int round = 0; round < 200; ++round) {
    Corners corners;
    for (V3d& c : corners) c = V3d(any(rng), any(rng), any(rng));
    const Cells whole = cells_of(corners, {V3i(0), V3i(cells)});
    Cells parts;
    for (const V3i& low : {V3i(0, 0, 0), V3i(4, 0, 0), V3i(0, 4, 0), V3i(4, 4, 0), V3i(0, 0, 4),
                           V3i(4, 0, 4), V3i(0, 4, 4), V3i(4, 4, 4)}) {
      const V3i high(low.x ? cells : 4, low.y ? cells : 4, low.z ? cells : 4);
      parts.merge(cells_of(corners, {low, high}));
    }
    ASSERT_EQ(whole, parts);
  }
}

}  // namespace
}  // namespace lacuna
