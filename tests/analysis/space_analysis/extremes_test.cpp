// The whole chain, from triangles to portals, on scenes at the ends of what there is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/space/components.h"
#include "analysis/space/memory_limit.h"
#include "analysis/space_analysis/space_analysis.h"
#include "tests/analysis/space_analysis/rooms.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using Imath::V3d;
using Imath::V3f;
using Imath::V3i;

/// An analysis with a cache of its own.
class Chain {
 public:
  Chain(TriangleSoup soup, int resolution, DomainSeeds seeds)
      : store_({.folder = folder_.path(),
                .byte_limit = 1 << 30,
                .label = {},
                .message = {},
                .warning = {},
                .interrupted = {}}),
        space_({.triangles = [soup = std::move(soup)] { return soup; },
                .geometry = "00",
                .seeds = [seeds = std::move(seeds)] { return seeds; },
                .settings = {.resolution = resolution},
                .byte_limit = [] { return std::uint64_t{2} << 30; }},
               store_, pool_) {}

  SpaceAnalysis& operator*() { return space_; }
  SpaceAnalysis* operator->() { return &space_; }

 private:
  TemporaryFolder folder_;
  const ThreadPool pool_{2};
  ArtefactStore store_;
  SpaceAnalysis space_;
};

DomainSeeds at(V3d camera) { return {{{camera, std::nullopt}}, false}; }
const DomainSeeds everywhere{{}, true};

TriangleSoup moved(TriangleSoup soup, float scale, float by) {
  for (V3f& p : soup.positions) p = p * scale + V3f(by);
  return soup;
}

/// What holds for every scene: each voxel of the domain, and no other, has a node (of either graph)
/// and a region; each 26-component of the domain has a skeleton of one piece.
void expect_whole(SpaceAnalysis& space) {
  const BitGrid3& domain = space.domain().voxels;
  const auto& maps = {&space.node_map(), &space.filtered_map()};
  const RegionLabels& regions = space.regions();
  for (std::size_t i = 0; i < regions.label.count(); ++i) {
    const bool inside = domain.get(regions.label.voxel(i));
    ASSERT_EQ(regions.label[i] != no_region, inside) << regions.label.voxel(i);
    for (const auto* map : maps) ASSERT_EQ((*map)[i] != no_node, inside) << map->voxel(i);
  }
  const std::size_t components =
      connected_components(domain, Connectivity::corners, ThreadPool(1), no_memory_limit).count();
  EXPECT_EQ(space.domain().components_kept, components);
  for (const SkeletonGraph* graph : {&space.skeleton(), &space.filtered().graph}) {
    std::vector<bool> seen(graph->nodes());
    std::size_t pieces = 0;
    for (std::uint32_t start = 0; start < graph->nodes(); ++start) {
      if (seen[start]) continue;
      ++pieces;
      std::vector<std::uint32_t> stack{start};
      for (seen[start] = true; !stack.empty();) {
        const std::uint32_t node = stack.back();
        stack.pop_back();
        for (const std::uint32_t other : graph->of(node)) {
          if (!seen[other]) stack.push_back(other);
          seen[other] = true;
        }
      }
    }
    EXPECT_EQ(pieces, components);
  }
  space.gates(), space.portals();
}

TEST(Extremes, AllResolutionsFromOneVoxelOn) {
  for (const int resolution : {1, 2, 3, 4, 5, 6, 7, 9, 12, 17, 31, 64, 101}) {
    SCOPED_TRACE(resolution);
    Chain outside(test::two_rooms(), resolution, everywhere);
    expect_whole(*outside);
    Chain inside(test::two_rooms(), resolution, at({2, 2, 1}));
    expect_whole(*inside);
    EXPECT_TRUE(resolution < 31 || inside->skeleton().nodes() > 0);
  }
}

TEST(Extremes, AMillionthAMillionAndTenMillionAwayAreTheSame) {
  Chain here(test::two_rooms(), 60, at({2, 2, 1}));
  ASSERT_GT(here->filtered().graph.nodes(), 0u);
  // Powers of two, and whole coordinates: the same shape to the last bit.
  for (const auto& [scale, by] : {std::pair{std::ldexp(1.0F, -20), 0.0F},
                                  {std::ldexp(1.0F, 20), 0.0F},
                                  {2.0F, 1e7F},
                                  {2.0F, -1e7F}}) {
    SCOPED_TRACE(::testing::Message() << scale << " " << by);
    const double s = scale;
    Chain there(moved(test::two_rooms(), scale, by), 60, at(V3d(2 * s, 2 * s, s) + V3d(by)));
    expect_whole(*there);
    EXPECT_EQ(there->skeleton().corners, here->skeleton().corners);
    EXPECT_EQ(there->skeleton().radii, here->skeleton().radii);
    EXPECT_EQ(there->filtered().parent, here->filtered().parent);
    EXPECT_EQ(there->portals().voxels, here->portals().voxels);
  }
}

TEST(Extremes, NoTriangleNoGrid) {
  Chain none({}, 16, everywhere);
  EXPECT_THROW(none->portals(), GeometryError);
}

TEST(Extremes, APointIsOneVoxelThatIsFull) {
  TriangleSoup soup;
  soup.positions.assign(3, Imath::V3f(1, 2, 3));
  soup.triangles = {{0, 1, 2}};
  Chain point(soup, 16, everywhere);
  EXPECT_EQ(point->voxels().scene.size(), V3i(1));
  expect_whole(*point);
  EXPECT_EQ(point->skeleton().nodes(), 0u);
}

TEST(Extremes, AWallWithNothingAroundIt) {
  TriangleSoup wall;
  test::add_wall(wall, {0, 0, 0}, {3, 0, 0}, {0, 2, 0});
  Chain chain(wall, 32, everywhere);
  EXPECT_EQ(chain->voxels().scene.size().z, 1);
  expect_whole(*chain);
  EXPECT_EQ(chain->skeleton().nodes(), 0u);  // no voxel is empty
}

TEST(Extremes, WithoutSeedsThereIsNoDomain) {
  Chain chain(test::two_rooms(), 32, {});
  expect_whole(*chain);
  EXPECT_EQ(chain->skeleton().nodes(), 0u);
  EXPECT_TRUE(chain->portals().portals.empty());
}

TEST(Extremes, ABoxIsOneRoom) {
  Chain chain(test::box({3, 2, 1}), 48, at({1, 1, 0.5}));
  expect_whole(*chain);
  EXPECT_EQ(chain->regions().regions.size(), 1u);
  EXPECT_TRUE(chain->portals().portals.empty());
}

// Walls meet the first and the last voxel of each side: 1024 x 1 x 1 voxels are empty.
TEST(Extremes, ATunnelOneVoxelWideIsOnePath) {
  Chain chain(test::box({1026, 2.5F, 2.5F}), 1026, at({5, 1.25, 1.25}));
  ASSERT_EQ(chain->voxels().scene.size(), V3i(1026, 3, 3));
  expect_whole(*chain);
  EXPECT_EQ(chain->domain().voxels_kept, 1024u);
  const SkeletonGraph& path = chain->skeleton();
  EXPECT_GT(path.nodes(), 1000u);
  EXPECT_EQ(path.edges() + 1, path.nodes());
  for (std::uint32_t node = 0; node < path.nodes(); ++node) EXPECT_LE(path.degree(node), 2u);
  // Who walks through meets the nodes in the order of the path.
  const auto& map = chain->node_map();
  for (int x = 1; x < 1024; ++x) {
    EXPECT_LE(path.corners[map(V3i(x, 1, 1))].x, path.corners[map(V3i(x + 1, 1, 1))].x) << x;
  }
}

// Around every pebble a cavity of the empty space is pierced, and the skeleton stays one piece.
TEST(Extremes, AThousandPebblesFloat) {
  TriangleSoup soup = test::box({41, 41, 41});
  for (int i = 0; i < 1000; ++i) {
    const V3f p = V3f(V3i(i % 10, i / 10 % 10, i / 100)) * 4.0F + V3f(2.5F);
    const auto n = static_cast<std::uint32_t>(soup.positions.size());
    soup.positions.push_back(p);
    soup.triangles.push_back({n, n, n});
  }
  Chain chain(std::move(soup), 41, at({1.5, 1.5, 1.5}));
  expect_whole(*chain);
  EXPECT_EQ(chain->domain().voxels_kept, 39u * 39 * 39 - 1000);
}

}  // namespace
}  // namespace lacuna
