#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "analysis/geometry/morton.h"
#include "analysis/octree/surface_octree.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space/triangle_box.h"

namespace lacuna {
namespace {

using Imath::V3d;
using Imath::V3f;
using Imath::V3i;

TriangleSoup random_soup(int triangles, float size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> at(0, 10), by(-size, size);
  TriangleSoup soup;
  for (int i = 0; i < triangles; ++i) {
    const V3f p(at(random), at(random), at(random));
    const auto n = static_cast<std::uint32_t>(soup.positions.size());
    soup.positions.push_back(p);
    soup.positions.push_back(p + V3f(by(random), by(random), by(random)));
    soup.positions.push_back(p + V3f(by(random), by(random), by(random)));
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  return soup;
}

/// What every octree is.
void expect_whole(const Octree& tree, int levels) {
  ASSERT_EQ(tree.levels(), levels);
  std::size_t children = 0;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const Octree::Node& node = tree.nodes[i];
    EXPECT_EQ(node.children == 0, node.level == levels);
    const float half = tree.side / static_cast<float>(4 << node.level);
    for (std::uint32_t c = 0; c < node.children; ++c) {
      const Octree::Node& child = tree.nodes[node.first_child + c];
      EXPECT_EQ(child.level, node.level + 1);
      for (int a = 0; a < 3; ++a) {
        EXPECT_NEAR(std::abs(child.centre[a] - node.centre[a]), half, 1e-3F * half);
      }
    }
    children += node.children;
  }
  EXPECT_EQ(children + 1, tree.nodes.size()) << "each has one parent, but for the root";
}

class SurfaceOctree : public testing::TestWithParam<int> {};

TEST_P(SurfaceOctree, LeavesAreTheCubesThatTrianglesMeet) {
  const int levels = GetParam();
  const ThreadPool pool(2);
  for (const float size : {0.3F, 12.0F}) {
    const TriangleSoup soup = random_soup(60, size, 5);
    const Octree tree = surface_octree(soup, levels, pool, no_memory_limit);
    expect_whole(tree, levels);
    // Every cube of the grid, one after another.
    const OctreeCube cube = octree_cube(soup, levels);
    const int n = 1 << levels;
    const GridTransform cells{cube.corner, cube.side / n};
    std::set<std::array<int, 3>> expected;
    for (const auto& t : soup.triangles) {
      std::array<V3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = cells.to_grid(V3d(soup.positions[t[k]]));
      const TriangleBox box(corners);
      for (int z = 0; z < n; ++z) {
        for (int y = 0; y < n; ++y) {
          for (int x = 0; x < n; ++x) {
            box.for_each_line({V3i(x, y, z), V3i(x + 1, y + 1, z + 1)}, [&](int, V3i, int) {
              expected.insert({x, y, z});
            });
          }
        }
      }
    }
    std::set<std::array<int, 3>> found;
    for (const Octree::Node& leaf : tree.leaves()) {
      const V3d at = cells.to_grid(V3d(leaf.centre));
      found.insert({static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)});
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(found.size(), tree.leaves().size());
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, SurfaceOctree, testing::Values(0, 1, 3, 5));

TEST(SurfaceOctree, IsTheSameForAnyNumberOfThreads) {
  const TriangleSoup soup = random_soup(500, 2, 9);
  const Octree one = surface_octree(soup, 7, ThreadPool(1), no_memory_limit);
  const Octree two = surface_octree(soup, 7, ThreadPool(2), no_memory_limit);
  ASSERT_EQ(one.nodes.size(), two.nodes.size());
  for (std::size_t i = 0; i < one.nodes.size(); ++i) {
    EXPECT_EQ(one.nodes[i].centre, two.nodes[i].centre);
    EXPECT_EQ(one.nodes[i].first_child, two.nodes[i].first_child);
  }
}

// A resolution between powers of two: 2^levels leaves along the longest side, in a larger root.
TEST(SurfaceOctree, LevelsNeedNotBeWhole) {
  const TriangleSoup soup = random_soup(60, 3, 5);
  const double longest = octree_cube(soup, 5).side;
  std::size_t before = surface_octree(soup, 5, ThreadPool(1), no_memory_limit).leaves().size();
  for (const double levels : {5.3, 5.6, 5.9}) {
    const OctreeCube cube = octree_cube(soup, levels);
    EXPECT_EQ(cube.levels, 6);
    EXPECT_NEAR(longest / (cube.side / 64), std::exp2(levels), 1e-9);
    const Octree tree = surface_octree(soup, levels, ThreadPool(2), no_memory_limit);
    expect_whole(tree, 6);
    EXPECT_GT(tree.leaves().size(), before);
    before = tree.leaves().size();
  }
}

TEST(SurfaceOctree, AtItsEnds) {
  const ThreadPool pool(1);
  EXPECT_TRUE(surface_octree({}, 5, pool, no_memory_limit).empty());
  // All triangles in one point.
  TriangleSoup point;
  point.positions.assign(3, V3f(1, 2, 3));
  point.triangles = {{0, 1, 2}};
  const Octree tree = surface_octree(point, 4, pool, no_memory_limit);
  expect_whole(tree, 4);
  EXPECT_LE(tree.leaves().size(), 8U);
  EXPECT_THROW(surface_octree(random_soup(100, 5, 1), 12, pool, 1000), MemoryLimitError);
}

TEST(Morton, CodesAreInterleavedBits) {
  for (const std::uint64_t v : {0ULL, 1ULL, 5ULL, 0x155555ULL, 0x1fffffULL}) {
    for (int bit = 0; bit < 21; ++bit) {
      EXPECT_EQ(morton_code(v, 0, 0) >> (3 * bit) & 1, v >> bit & 1);
      EXPECT_EQ(morton_code(0, v, 0) >> (3 * bit + 1) & 1, v >> bit & 1);
      EXPECT_EQ(morton_code(0, 0, v) >> (3 * bit + 2) & 1, v >> bit & 1);
    }
  }
}

}  // namespace
}  // namespace lacuna
