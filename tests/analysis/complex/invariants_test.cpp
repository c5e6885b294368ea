#include "analysis/complex/invariants.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <numeric>
#include <tuple>

#include "analysis/complex/complex_components.h"
#include "tests/analysis/complex/random_voxels.h"

namespace lacuna {
namespace {

BitGrid3 solid(Imath::V3i size, const std::function<bool(Imath::V3i)>& inside) {
  BitGrid3 g(size);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (inside({x, y, z})) g.set(x, y, z);
      }
    }
  }
  return g;
}

TEST(Topology, OfShapesThatAreKnown) {
  const auto box = solid({9, 20, 11}, [](Imath::V3i) { return true; });
  EXPECT_EQ(topology(CubicalComplex(box)), (Topology{1, 1, 0, 0}));
  const auto shell = solid({9, 20, 11}, [](Imath::V3i v) {
    return v.x == 0 || v.y == 0 || v.z == 0 || v.x == 8 || v.y == 19 || v.z == 10;
  });
  EXPECT_EQ(topology(CubicalComplex(shell)), (Topology{2, 1, 0, 1}));
  const auto ring =
      solid({9, 20, 1}, [](Imath::V3i v) { return v.x == 0 || v.y == 0 || v.x == 8 || v.y == 19; });
  EXPECT_EQ(topology(CubicalComplex(ring)), (Topology{0, 1, 1, 0}));
  const auto two_rings = solid({9, 20, 3}, [](Imath::V3i v) {
    return v.z != 1 && (v.x == 0 || v.y == 0 || v.x == 8 || v.y == 19);
  });
  EXPECT_EQ(topology(CubicalComplex(two_rings)), (Topology{0, 2, 2, 0}));
  // Voxels that share a corner only are one component of the closed complex.
  const auto corner = solid({2, 2, 2}, [](Imath::V3i v) { return v.x == v.y && v.y == v.z; });
  EXPECT_EQ(topology(CubicalComplex(corner)), (Topology{1, 1, 0, 0}));
  EXPECT_EQ(topology(CubicalComplex(BitGrid3({5, 5, 5}))), (Topology{0, 0, 0, 0}));
}

/// Components by flooding, cell by cell.
int flood_count(Imath::V3i low, Imath::V3i high, const std::function<bool(Imath::V3i)>& exists,
                const std::function<bool(Imath::V3i, Imath::V3i)>& linked) {
  std::map<std::tuple<int, int, int>, int> label;
  int count = 0;
  for (int z = low.z; z <= high.z; ++z) {
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        if (!exists({x, y, z}) || label.contains({x, y, z})) continue;
        std::vector<Imath::V3i> stack{{x, y, z}};
        label[{x, y, z}] = count;
        while (!stack.empty()) {
          const Imath::V3i v = stack.back();
          stack.pop_back();
          for (int axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
              Imath::V3i w = v;
              w[axis] += step;
              if (w[axis] < low[axis] || w[axis] > high[axis] || !exists(w)) continue;
              if (!linked(v, w) || label.contains({w.x, w.y, w.z})) continue;
              label[{w.x, w.y, w.z}] = count;
              stack.push_back(w);
            }
          }
        }
        ++count;
      }
    }
  }
  return count;
}

TEST(Topology, AgreesWithFlooding) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    const Imath::V3i size(6 + static_cast<int>(seed) * 11 % 70, 9, 10);
    const BitGrid3 voxels = testing::random_voxels(size, 0.2 + 0.05 * seed, 0, seed);
    CubicalComplex c(voxels);
    const auto vertices = flood_count(
        Imath::V3i(0), size, [&](Imath::V3i v) { return c.has(v, 0); },
        [&](Imath::V3i a, Imath::V3i b) {
          const int axis = a.x != b.x ? 0 : a.y != b.y ? 1 : 2;
          return c.has(a[axis] < b[axis] ? a : b, 1 << axis);
        });
    const auto in_cells = [&](Imath::V3i v) {
      return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x <= size.x && v.y <= size.y && v.z <= size.z;
    };
    const auto complement = flood_count(
        Imath::V3i(-1), size + Imath::V3i(1),
        [&](Imath::V3i v) { return !in_cells(v) || !c.has(v, 7); },
        [&](Imath::V3i a, Imath::V3i b) {
          const int axis = a.x != b.x ? 0 : a.y != b.y ? 1 : 2;
          const Imath::V3i high = a[axis] > b[axis] ? a : b;
          return !in_cells(high) || !c.has(high, 7 & ~(1 << axis));
        });
    const Topology t = topology(c);
    EXPECT_EQ(t.components, vertices);
    EXPECT_EQ(t.cavities, complement - 1);
    EXPECT_EQ(t.euler, t.components - t.tunnels + t.cavities);
    EXPECT_GE(t.tunnels, 0);
  }
}

}  // namespace
}  // namespace lacuna
