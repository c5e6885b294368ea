#include "analysis/complex/collapse.h"

#include <gtest/gtest.h>

#include <map>
#include <tuple>

#include "tests/analysis/complex/literal_collapse.h"
#include "tests/analysis/complex/random_voxels.h"

namespace lacuna {
namespace {

using testing::LiteralComplex;
using testing::random_voxels;

struct Shape {
  Imath::V3i size;
  double density;
  int smooth;
};

std::vector<Shape> shapes() {
  std::vector<Shape> all;
  for (const double density : {0.1, 0.5, 0.9}) all.push_back({{19, 11, 17}, density, 0});
  all.push_back({{20, 20, 20}, 0.003, 4});
  all.push_back({{9, 26, 10}, 0.01, 3});
  all.push_back({{8, 8, 8}, 1.0, 0});
  all.push_back({{1, 1, 1}, 1.0, 0});
  all.push_back({{30, 1, 1}, 0.8, 0});
  all.push_back({{17, 16, 15}, 1.0, 0});
  return all;
}

void expect_same(const CubicalComplex& fast, const LiteralComplex& literal) {
  const Imath::V3i n = fast.size();
  for (int z = 0; z <= n.z; ++z) {
    for (int y = 0; y <= n.y; ++y) {
      for (int x = 0; x <= n.x; ++x) {
        for (FaceType m = 0; m < face_types; ++m) {
          ASSERT_EQ(fast.has({x, y, z}, m), literal.has({x, y, z}, m))
              << x << ' ' << y << ' ' << z << " type " << m;
        }
      }
    }
  }
}

const auto nothing_kept = [](Imath::V3i, FaceType) { return false; };

TEST(CubicalComplex, IsTheClosureOfItsCubes) {
  for (unsigned seed = 0; const Shape& s : shapes()) {
    const BitGrid3 voxels = random_voxels(s.size, s.density, s.smooth, ++seed);
    const CubicalComplex c(voxels);
    for (int z = 0; z <= s.size.z; ++z) {
      for (int y = 0; y <= s.size.y; ++y) {
        for (int x = 0; x <= s.size.x; ++x) {
          for (FaceType m = 0; m < face_types; ++m) {
            bool expected = false;
            for (int back = 0; back < face_types; ++back) {
              if ((back & m) != 0) continue;
              const Imath::V3i v(x - (back & 1), y - (back >> 1 & 1), z - (back >> 2 & 1));
              expected = expected || (v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < s.size.x &&
                                      v.y < s.size.y && v.z < s.size.z && voxels.get(v));
            }
            ASSERT_EQ(c.has({x, y, z}, m), expected) << x << ' ' << y << ' ' << z << " type " << m;
          }
        }
      }
    }
  }
}

TEST(CubicalComplex, TellsItsFacesWithoutBeingMade) {
  for (unsigned seed = 0; const Shape& s : shapes()) {
    const BitGrid3 voxels = random_voxels(s.size, s.density, s.smooth, ++seed);
    const CubicalComplex c(voxels);
    EXPECT_EQ(closure_faces(voxels), c.count(0) + c.count(1) + c.count(2) + c.count(3));
  }
}

TEST(Collapse, IsAlgorithm2LayerByLayer) {
  for (unsigned seed = 0; const Shape& s : shapes()) {
    const CubicalComplex whole(random_voxels(s.size, s.density, s.smooth, ++seed));
    LiteralComplex literal(whole);
    for (int layers = 1; literal.layer(nothing_kept); ++layers) {
      CubicalComplex fast = whole;
      EXPECT_EQ(collapse(fast, KeptEdges(fast), nullptr, layers), layers);
      expect_same(fast, literal);
      if (HasFatalFailure()) FAIL() << "shape " << seed << ", layer " << layers;
    }
    CubicalComplex fast = whole;
    collapse(fast, KeptEdges(fast));
    expect_same(fast, literal);
  }
}

TEST(Collapse, KeepsWhatItMust) {
  for (unsigned seed = 100; const Shape& s : shapes()) {
    const CubicalComplex whole(random_voxels(s.size, s.density, s.smooth, ++seed));
    KeptEdges kept(whole);
    std::map<std::tuple<int, int, int, int>, bool> in_w;
    std::mt19937 random(seed);
    for (std::size_t b = 0; b < whole.block_count(); ++b) {
      for (int axis = 0; axis < 3; ++axis) {
        BitBlock some;
        for_each_bit(whole.data()[b].faces[std::size_t{1} << axis], [&](int position) {
          if (random() % 50 != 0) return;
          const Imath::V3i c = cell_of(position), cell = whole.corner(b) + c;
          some.z[static_cast<std::size_t>(c.z)] |= std::uint64_t{1} << (c.y * 8 + c.x);
          const Imath::V3i end = cell + Imath::V3i(axis == 0, axis == 1, axis == 2);
          in_w[{cell.x, cell.y, cell.z, 1 << axis}] = true;
          in_w[{cell.x, cell.y, cell.z, 0}] = true;
          in_w[{end.x, end.y, end.z, 0}] = true;
        });
        if (some.any()) kept.add(b, axis, Plane::of(some));
      }
    }
    LiteralComplex literal(whole);
    while (literal.layer([&](Imath::V3i c, FaceType m) {
      return in_w.contains({c.x, c.y, c.z, m});
    })) {
    }
    CubicalComplex fast = whole;
    collapse(fast, kept);
    expect_same(fast, literal);
    EXPECT_EQ(fast.euler(), whole.euler());
    CubicalComplex again = fast;
    EXPECT_EQ(collapse(again, kept), 0);
    EXPECT_TRUE(again == fast);
  }
}

/// Facet edges as the observer is told of them, by their first date.
class Births : public LayerObserver {
 public:
  explicit Births(const CubicalComplex& c) : complex_(c) {}
  void edges(int date, std::size_t block, const std::array<Plane, 3>& present,
             const std::array<Plane, 3>& facets) override {
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      EXPECT_FALSE((facets[a] & ~present[a]).any());
      for_each_bit(facets[a], [&](int position) {
        const Imath::V3i c = complex_.corner(block) + cell_of(position);
        born.try_emplace({c.x, c.y, c.z, axis}, date);
      });
    }
  }
  std::map<std::tuple<int, int, int, int>, int> born;

 private:
  const CubicalComplex& complex_;
};

TEST(Collapse, TellsOfFacetEdgesWhenTheyAreBorn) {
  const Shape s{{20, 14, 20}, 0.004, 4};
  const CubicalComplex whole(random_voxels(s.size, s.density, s.smooth, 7));
  CubicalComplex fast = whole;
  Births births(fast);
  collapse(fast, KeptEdges(fast), &births);
  std::map<std::tuple<int, int, int, int>, int> expected;
  LiteralComplex literal(whole);
  int date = 0;
  do {
    for (int z = 0; z <= s.size.z; ++z) {
      for (int y = 0; y <= s.size.y; ++y) {
        for (int x = 0; x <= s.size.x; ++x) {
          for (int axis = 0; axis < 3; ++axis) {
            if (literal.has({x, y, z}, 1 << axis) && literal.is_facet({x, y, z}, 1 << axis)) {
              expected.try_emplace({x, y, z, axis}, date);
            }
          }
        }
      }
    }
    ++date;
  } while (literal.layer(nothing_kept));
  EXPECT_EQ(births.born, expected);
  EXPECT_GT(expected.size(), 10u);
}

}  // namespace
}  // namespace lacuna
