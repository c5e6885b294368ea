// The walk along a ray against every face by itself, and mixtures of regions.

#include "renderer/guides/crossed_faces.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>

#include "renderer/guides/region_mixture.h"

namespace lacuna {
namespace {

using Imath::V3d;
using Imath::V3i;

using Crossing = std::tuple<int, int, int, int>;  // axis, and the voxel beyond, the higher one

/// Where the ray meets the plane of each face of the box, one by one.
std::set<Crossing> by_brute_force(const V3d& x, const V3d& w, const VoxelBox& box) {
  std::set<Crossing> all;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int i = box.low[axis] + 1; i < box.high[axis]; ++i) {
      const double t = (i - x[axis]) / w[axis];
      if (!(t > 0) || !std::isfinite(t)) continue;
      const V3d at = x + w * t;
      V3i voxel;
      voxel[axis] = i;
      voxel[u] = static_cast<int>(std::floor(at[u]));
      voxel[v] = static_cast<int>(std::floor(at[v]));
      if (voxel[u] < box.low[u] || voxel[u] >= box.high[u]) continue;
      if (voxel[v] < box.low[v] || voxel[v] >= box.high[v]) continue;
      all.insert({axis, voxel.x, voxel.y, voxel.z});
    }
  }
  return all;
}

TEST(CrossedFaces, AreAllThatTheRayMeets) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> place(-6, 14), direction(-1, 1);
  std::uniform_int_distribution<int> corner(-2, 9);
  std::size_t met = 0;
  for (int round = 0; round < 20000; ++round) {
    VoxelBox box;
    box.add(V3i(corner(random), corner(random), corner(random)));
    box.add(V3i(corner(random), corner(random), corner(random)));
    const V3d x(place(random), place(random), place(random));
    V3d w(direction(random), direction(random), direction(random));
    if (round % 5 == 0) w[round / 5 % 3] = 0;
    std::set<Crossing> found;
    double before = 0;
    for_each_crossed_face({x, w}, box, [&](const CrossedFace& face) {
      const V3i high(std::max(face.from.x, face.to.x), std::max(face.from.y, face.to.y),
                     std::max(face.from.z, face.to.z));
      EXPECT_TRUE(found.insert({face.axis, high.x, high.y, high.z}).second);
      EXPECT_GE(face.t, before);
      before = face.t;
      // The point lies on the face.
      const V3d at = x + w * face.t;
      EXPECT_NEAR(at[face.axis], high[face.axis], 1e-9);
      return true;
    });
    EXPECT_EQ(found, by_brute_force(x, w, box)) << x << w << box.low << box.high;
    met += found.size();
  }
  EXPECT_GT(met, 1000U);
}

TEST(CrossedFaces, EndWhereTheVisitorDoes) {
  VoxelBox box{V3i(0), V3i(10)};
  int met = 0;
  for_each_crossed_face({V3d(0.5), V3d(1, 0.1, 0.2)}, box,
                        [&](const CrossedFace&) { return ++met < 3; });
  EXPECT_EQ(met, 3);
  EXPECT_TRUE(VoxelBox{}.empty());
}

/// Two regions, parted at x = 8, in a grid that ends at 16.
Grid3<std::uint32_t> halves() {
  Grid3<std::uint32_t> label(V3i(16));
  for (std::size_t i = 0; i < label.count(); ++i) {
    label[i] = label.voxel(i).x < 8 ? 0 : 1;
    if (label.voxel(i).y == 15) label[i] = no_region;
  }
  return label;
}

double weight(const RegionMixture& mixture, std::uint32_t region) {
  double sum = 0;
  for (const auto& share : mixture) sum += share.region == region ? share.weight : 0;
  return sum;
}

TEST(RegionMixture, ChangesContinuouslyAndAddsUp) {
  const Grid3<std::uint32_t> label = halves();
  double before = 1;
  for (int i = 0; i < 159; ++i) {
    const double x = 0.05 + 0.1 * i;
    const V3d at(x, 5.3, 7.7);
    const std::uint32_t own = label(V3i(at));
    const RegionMixture mixed = RegionLattice(label, 4).mixture(at, own);
    EXPECT_NEAR(weight(mixed, 0) + weight(mixed, 1), 1, 1e-12);
    EXPECT_LE(std::abs(weight(mixed, 0) - before), 0.1 / 4 + 1e-9);
    before = weight(mixed, 0);
    const RegionMixture alone = RegionLattice(label, 0).mixture(at, own);
    EXPECT_EQ(weight(alone, x < 8 ? 0 : 1), 1);
  }
  EXPECT_EQ(before, 0);
}

TEST(RegionMixture, LeavesOutWhatIsNoRegion) {
  const Grid3<std::uint32_t> label = halves();
  const V3d at(6.5, 14.6, 3);
  const RegionLattice lattice(label, 4);
  const RegionMixture mixed = lattice.mixture(at, label(6, 14, 3));
  EXPECT_NEAR(weight(mixed, 0) + weight(mixed, 1), 1, 1e-12);
  // Outside the grid nothing is known but the region itself.
  const RegionMixture outside = lattice.mixture(V3d(-20, 3, 3), label(0, 3, 3));
  EXPECT_EQ(weight(outside, 0), 1);
}

}  // namespace
}  // namespace lacuna
