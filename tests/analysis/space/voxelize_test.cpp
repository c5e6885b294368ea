#include <gtest/gtest.h>

#include <limits>

#include "analysis/space/components.h"
#include "analysis/space/domain.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/voxelize.h"
#include "tests/analysis/space/soups_and_grids.h"

namespace lacuna {
namespace {

using Imath::V3d;
using Imath::V3f;
using Imath::V3i;

Voxels voxels_of(const TriangleSoup& soup, int resolution) {
  return voxelize(soup, resolution, one_thread(), no_memory_limit);
}

/// No 26-path of empty voxels leads from the voxel of `inside` to the grid's border.
void expect_closed(const TriangleSoup& soup, int resolution, V3d inside) {
  const Voxels v = voxelize(soup, resolution, four_threads(), no_memory_limit);
  const Components c = connected_components(empty_voxels(v.scene), Connectivity::corners,
                                            one_thread(), no_memory_limit);
  const std::uint32_t component = c.at(V3i(v.transform.to_grid(inside)));
  ASSERT_NE(component, no_component) << "the inside is no empty voxel: the test is void";
  ASSERT_FALSE(c.touches_border[component]) << "leaks at resolution " << resolution;
}

TEST(Voxelize, LetsNothingThroughAClosedBoxAtAnyRotation) {
  std::mt19937 rng(41);
  std::uniform_real_distribution<double> u(-0.05, 0.05);
  for (int round = 0; round < 150; ++round) {
    TriangleSoup soup;
    const V3d centre(u(rng), u(rng), u(rng));
    // Every tenth is aligned with the grid, some with faces exactly between voxels.
    const auto axes = round % 10 == 0 ? std::array{V3d(1, 0, 0), V3d(0, 1, 0), V3d(0, 0, 1)}
                                      : random_rotation(rng);
    add_box(soup, round % 20 == 0 ? V3d(0) : centre, axes, {0.5, 0.25 + u(rng), 0.375});
    add_point(soup, V3d(-1));
    add_point(soup, V3d(1));
    expect_closed(soup, std::array{16, 17, 40, 65, 64}[static_cast<std::size_t>(round % 5)],
                  centre);
  }
}

TEST(Voxelize, LetsNothingThroughAClosedSphere) {
  std::mt19937 rng(42);
  std::uniform_real_distribution<double> u(-0.05, 0.05);
  for (const int triangles : {3, 5, 16, 100}) {
    for (int round = 0; round < 20; ++round) {
      TriangleSoup soup;
      const V3d centre(u(rng), u(rng), u(rng));
      add_sphere(soup, centre, random_rotation(rng), 0.6, triangles);
      add_point(soup, V3d(-1));
      add_point(soup, V3d(1));
      expect_closed(soup, 20 + 7 * round, centre);
    }
  }
}

TEST(Voxelize, LetsNothingThroughAtAnyScaleAndPlace) {
  std::mt19937 rng(43);
  // At 1e7 float positions are whole numbers, at -3e9 multiples of 256: the box is bent, and
  // closed.
  for (const auto& [scale, place] : {std::pair(1e-6, 0.0),
                                     {1e-6, 1e-3},
                                     {300.0, 1e7},
                                     {2.0, 1e7},
                                     {1e6, -3e9},
                                     {1e-20, 0.0},
                                     {1e30, 0.0}}) {
    TriangleSoup soup;
    const V3d at(place, -place, place);
    add_box(soup, at, random_rotation(rng), V3d(0.5, 0.4, 0.6) * scale);
    add_point(soup, at - V3d(scale));
    add_point(soup, at + V3d(scale));
    expect_closed(soup, scale == 2.0 ? 64 : 41, at);
  }
}

TEST(Voxelize, HasTheSameBitsAtAnotherScalePlaceAndNumberOfThreads) {
  std::mt19937 rng(44);
  std::uniform_int_distribution<int> any(0, 1 << 10);
  TriangleSoup soup, moved, scaled;
  for (int i = 0; i < 400; ++i) {
    std::array<V3d, 3> c;
    for (V3d& p : c) p = V3d(any(rng), any(rng), any(rng));
    if (i % 3 != 0)  // small ones
      for (std::size_t k = 1; k < 3; ++k) c[k] = c[0] + (c[k] - c[0]) / 64;
    add_triangle(soup, c[0], c[1], c[2]);
    add_triangle(scaled, c[0] / (1 << 20), c[1] / (1 << 20), c[2] / (1 << 20));
    const V3d far(1 << 13);  // fine enough for the sixty-fourths to stay exact
    add_triangle(moved, c[0] + far, c[1] + far, c[2] + far);
  }
  for (const int resolution : {1, 7, 100}) {
    const Voxels a = voxels_of(soup, resolution);
    EXPECT_EQ(a.scene, voxelize(soup, resolution, four_threads(), no_memory_limit).scene);
    EXPECT_EQ(a.scene, voxels_of(scaled, resolution).scene);
    EXPECT_EQ(a.scene, voxels_of(moved, resolution).scene);
  }
}

TEST(Voxelize, AWallBetweenVoxelsIsOnBothSides) {
  TriangleSoup soup;
  add_point(soup, V3d(0));
  add_point(soup, V3d(8));
  add_triangle(soup, {0, 0, 4}, {8, 0, 4}, {8, 8, 4});
  add_triangle(soup, {0, 0, 4}, {8, 8, 4}, {0, 8, 4});
  const Voxels v = voxels_of(soup, 8);
  ASSERT_EQ(v.scene.size(), V3i(8));
  EXPECT_EQ(v.scene.count(), 2u * 64 + 2);  // and the two points at the corners
  for (int x = 0; x < 8; ++x)
    for (int y = 0; y < 8; ++y) EXPECT_TRUE(v.scene.get(x, y, 3) && v.scene.get(x, y, 4));
}

TEST(Voxelize, HoldsEveryPointOfEveryTriangle) {
  std::mt19937 rng(45);
  std::uniform_real_distribution<double> u(0, 1);
  TriangleSoup soup;
  for (int i = 0; i < 300; ++i) {
    const double size = i % 10 == 0 ? 5 : 0.05;
    const V3d at(u(rng) * 5, u(rng) * 3, u(rng) * 0.3);
    add_triangle(soup, at, at + V3d(u(rng), u(rng), u(rng)) * size,
                 at + V3d(u(rng), -u(rng), u(rng)) * size);
  }
  for (const int resolution : {1, 5, 64, 200}) {
    const Voxels v = voxelize(soup, resolution, four_threads(), no_memory_limit);
    for (const auto& t : soup.triangles)
      for (int k = 0; k < 60; ++k) {
        double a = u(rng), b = u(rng);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        const V3d p = V3d(soup.positions[t[0]]) * (1 - a - b) + V3d(soup.positions[t[1]]) * a +
                      V3d(soup.positions[t[2]]) * b;
        const V3d g = v.transform.to_grid(p);
        V3i voxel;
        for (int axis = 0; axis < 3; ++axis)
          voxel[axis] =
              std::clamp(static_cast<int>(std::floor(g[axis])), 0, v.scene.size()[axis] - 1);
        ASSERT_TRUE(v.scene.get(voxel)) << "resolution " << resolution << ", voxel " << voxel;
      }
  }
}

TEST(Voxelize, GivesAGridToPointsSegmentsAndPlanes) {
  TriangleSoup point;
  add_point(point, {3, 4, 5});
  const Voxels one = voxels_of(point, 512);
  EXPECT_EQ(one.scene.size(), V3i(1));
  EXPECT_TRUE(one.scene.get(0, 0, 0));
  EXPECT_EQ(one.transform.voxel_size, 1);

  TriangleSoup segment;
  add_triangle(segment, {1, 2, 3}, {1, 2, 7}, {1, 2, 5});
  const Voxels line = voxels_of(segment, 9);
  EXPECT_EQ(line.scene.size(), V3i(1, 1, 9));
  EXPECT_EQ(line.scene.count(), 9u);

  TriangleSoup plane;
  add_triangle(plane, {0, 5, 0}, {4, 5, 0}, {4, 5, 2});
  add_triangle(plane, {0, 5, 0}, {4, 5, 2}, {0, 5, 2});
  const Voxels flat = voxels_of(plane, 40);
  EXPECT_EQ(flat.scene.size(), V3i(40, 1, 20));
  EXPECT_EQ(flat.scene.count(), 800u);
}

TEST(PlanGrid, HasResolutionVoxelsAlongTheLongestSide) {
  TriangleSoup soup;
  add_point(soup, {-1, 10, 3});
  add_point(soup, {2, 11, 4.01});
  for (const int resolution : {1, 2, 3, 30, 300, 1000, 2048}) {
    const GridPlan plan = plan_grid(soup, resolution);
    EXPECT_EQ(plan.size.x, resolution);
    EXPECT_EQ(plan.size.y, (resolution + 2) / 3);
    EXPECT_GE(plan.size.z, plan.size.y);
    EXPECT_LE(plan.size.z * plan.transform.voxel_size, 1.01 + plan.transform.voxel_size * 1.001);
    EXPECT_EQ(plan.transform.origin, V3d(-1, 10, 3));
    EXPECT_GE(plan.bytes, static_cast<std::uint64_t>(plan.size.x) * plan.size.y * plan.size.z / 8);
  }
}

TEST(PlanGrid, RefusesWhatItCannotPlan) {
  TriangleSoup none;
  EXPECT_THROW(plan_grid(none, 8), GeometryError);
  TriangleSoup soup;
  add_point(soup, V3d(0));
  add_point(soup, V3d(1));
  EXPECT_THROW(plan_grid(soup, 0), std::invalid_argument);
  EXPECT_THROW(plan_grid(soup, 2049), std::invalid_argument);
  TriangleSoup tiny;
  add_point(tiny, V3d(0));
  add_point(tiny, V3d(1e-30));
  EXPECT_THROW(plan_grid(tiny, 8), GeometryError);
  soup.positions[1].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(plan_grid(soup, 8), GeometryError);
}

TEST(Voxelize, IsRefusedBeforeItTakesTooMuchMemory) {
  TriangleSoup soup;
  add_point(soup, V3d(0));
  add_point(soup, V3d(1));
  const GridPlan plan = plan_grid(soup, 2048);
  EXPECT_GT(plan.bytes, 1u << 30);
  EXPECT_THROW(voxelize(soup, 2048, one_thread(), plan.bytes - 1), MemoryLimitError);
  try {
    voxelize(soup, 2048, one_thread(), 1 << 20);
    FAIL();
  } catch (const MemoryLimitError& e) {
    EXPECT_NE(std::string(e.what()).find("2048 x 2048 x 2048"), std::string::npos) << e.what();
  }
}

/// `count` placements of a sphere of 2 * n * n triangles, by exact transforms; and their copies.
struct PlacedSpheres {
  PlacedSpheres(int count, int n) {
    const std::array<V3d, 3> axes{V3d(1, 0, 0), V3d(0, 1, 0), V3d(0, 0, 1)};
    TriangleSoup sphere;
    add_sphere(sphere, V3d(0), axes, 1, n);
    placed.prototypes.push_back({sphere.positions, sphere.triangles});
    copies = sphere, placed.positions = sphere.positions, placed.triangles = sphere.triangles;
    std::mt19937 rng(45);
    std::uniform_int_distribution<int> at(-64, 64), power(-1, 2);
    for (int i = 0; i < count; ++i) {
      const float s = std::exp2f(static_cast<float>(power(rng)));
      placed.place({0,
                    {V3f(0, s, 0), V3f(-s, 0, 0), V3f(0, 0, s / 2)},
                    V3f(static_cast<float>(at(rng)), static_cast<float>(at(rng)),
                        static_cast<float>(at(rng)))});
      for (const auto& t : sphere.triangles) {
        const auto& p = placed.placements.back();
        add_triangle(copies, p.point(sphere.positions[t[0]]), p.point(sphere.positions[t[1]]),
                     p.point(sphere.positions[t[2]]));
      }
    }
  }
  TriangleSoup placed, copies;
};

/// The copies' corners are rounded to floats, the placements' are not: they may differ on a border.
std::size_t differing_voxels(const Voxels& a, const Voxels& b) {
  std::size_t count = 0;
  Imath::V3i v;
  for (v.z = 0; v.z < a.scene.size().z; ++v.z)
    for (v.y = 0; v.y < a.scene.size().y; ++v.y)
      for (v.x = 0; v.x < a.scene.size().x; ++v.x)
        count += a.scene.get(v) != b.scene.get(v) ? 1 : 0;
  return count;
}

TEST(Voxelize, PlacementsAreAsCopies) {
  const PlacedSpheres spheres(30, 6);
  ASSERT_EQ(spheres.placed.size(), spheres.copies.size());
  const Voxels placed = voxels_of(spheres.placed, 90), copies = voxels_of(spheres.copies, 90);
  ASSERT_EQ(placed.scene.size(), copies.scene.size());
  EXPECT_LT(differing_voxels(placed, copies), 3U);
  EXPECT_EQ(placed.scene, voxelize(spheres.placed, 90, four_threads(), no_memory_limit).scene);
}

/// More triangles than one batch has: the last placement counts as the first does.
TEST(LongVoxelize, TakesAnyNumberOfPlacements) {
  PlacedSpheres spheres(4, 64);
  const TriangleSoup few = spheres.placed;
  const TriangleSoup::Placement last{0, few.placements[0].axes, V3f(80, 80, 80)};
  while (spheres.placed.size() < (std::uint64_t{1} << 24) + 100) {
    spheres.placed.place(few.placements[spheres.placed.placements.size() % 4]);
  }
  spheres.placed.place(last);
  TriangleSoup alone = few;
  alone.place(last);
  EXPECT_EQ(voxels_of(spheres.placed, 100).scene, voxels_of(alone, 100).scene);
}

}  // namespace
}  // namespace lacuna
