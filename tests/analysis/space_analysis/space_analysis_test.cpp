#include "analysis/space_analysis/space_analysis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "analysis/space/memory_limit.h"
#include "tests/analysis/space_analysis/rooms.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using test::two_rooms;

class SpaceAnalysisTest : public ::testing::Test {
 protected:
  SpaceInput input(Imath::V3d camera, int resolution = 60) {
    return {.triangles =
                [this] {
                  ++soups_;
                  return two_rooms();
                },
            .geometry = "0123456789abcdef",
            .seeds =
                [camera] {
                  return DomainSeeds{{{camera, std::nullopt}}, false};
                },
            .settings = {.resolution = resolution},
            .byte_limit = [] { return std::uint64_t{1} << 30; }};
  }
  ArtefactStore store() {
    return ArtefactStore({.folder = folder_.path(),
                          .byte_limit = 1 << 30,
                          .label = {},
                          .message = {},
                          .warning = {},
                          .interrupted = {}});
  }
  static std::multiset<std::string> types(const ArtefactStore& store,
                                          ArtefactRecord::Origin origin) {
    std::multiset<std::string> names;
    for (const ArtefactRecord& r : store.records()) {
      if (r.origin == origin) names.insert(r.type);
    }
    return names;
  }

  TemporaryFolder folder_;
  const ThreadPool pool_{2};
  int soups_ = 0;
};

TEST_F(SpaceAnalysisTest, BuildsOnlyWhatIsAskedFor) {
  ArtefactStore s = store();
  SpaceAnalysis space(input({2, 2, 1}), s, pool_);
  EXPECT_EQ(soups_, 0);
  space.filtered();
  EXPECT_EQ(soups_, 1);
  space.close();
  using enum ArtefactRecord::Origin;
  EXPECT_EQ(types(s, built),
            (std::multiset<std::string>{"voxels", "domain", "skeleton", "filtered_skeleton"}));
  EXPECT_EQ(types(s, not_needed),
            (std::multiset<std::string>{"node_map", "filtered_map", "simplified_skeleton",
                                        "visibility_clusters", "visibility_gates", "regions",
                                        "portals"}));
}

TEST_F(SpaceAnalysisTest, FindsTheTwoRoomsAndTheirDoor) {
  ArtefactStore s = store();
  SpaceAnalysis space(input({2, 2, 1}), s, pool_);
  EXPECT_EQ(space.domain().components_kept, 1u);
  EXPECT_EQ(space.domain().components_dropped, 1u);  // the closet
  ASSERT_GT(space.skeleton().nodes(), 0u);
  const auto voxel = [&](double x) {
    const Imath::V3d g = space.voxels().transform.to_grid({x, 2, 1.5});
    return Imath::V3i(static_cast<int>(g.x), static_cast<int>(g.y), static_cast<int>(g.z));
  };
  const auto& label = space.regions().label;
  EXPECT_NE(label(voxel(2)), label(voxel(6)));
  EXPECT_EQ(label(voxel(9)), no_region);
  EXPECT_GE(space.portals().portals.size(), 1u);
  EXPECT_NE(space.node_map()(voxel(2)), no_node);
  EXPECT_EQ(space.node_map()(voxel(9)), no_node);
  EXPECT_LT(space.filtered().graph.nodes(), space.skeleton().nodes());
  EXPECT_GE(space.clusters().count, 1u);
}

TEST_F(SpaceAnalysisTest, TheNextFindsAllOfItInTheCache) {
  const auto ask_all = [](SpaceAnalysis& space) {
    space.node_map(), space.filtered_map(), space.gates(), space.portals();
  };
  ArtefactStore first = store(), second = store();
  SpaceAnalysis a(input({2, 2, 1}), first, pool_), b(input({2, 2, 1}), second, pool_);
  ask_all(a), ask_all(b);
  using enum ArtefactRecord::Origin;
  EXPECT_EQ(types(first, built).size(), 11u);
  EXPECT_TRUE(types(second, built).empty());
  EXPECT_EQ(soups_, 1);
  EXPECT_EQ(a.skeleton().corners, b.skeleton().corners);
  EXPECT_EQ(a.skeleton().neighbours, b.skeleton().neighbours);
  EXPECT_EQ(a.skeleton().radii, b.skeleton().radii);
  EXPECT_EQ(a.filtered().parent, b.filtered().parent);
  EXPECT_EQ(a.simplified().kinds, b.simplified().kinds);
  EXPECT_EQ(a.clusters().of_node, b.clusters().of_node);
  ASSERT_EQ(a.gates().gates.size(), b.gates().gates.size());
  const auto same = [](const auto& p, const auto& q) {
    return p.count() == q.count() && std::equal(p.data(), p.data() + p.count(), q.data());
  };
  EXPECT_TRUE(same(a.node_map(), b.node_map()));
  EXPECT_TRUE(same(a.filtered_map(), b.filtered_map()));
  EXPECT_TRUE(same(a.regions().label, b.regions().label));
  EXPECT_TRUE(same(a.regions().opening, b.regions().opening));
  EXPECT_EQ(a.portals().voxels, b.portals().voxels);
}

TEST_F(SpaceAnalysisTest, CamerasInOneRoomShareASkeleton) {
  ArtefactStore first = store(), second = store(), third = store();
  SpaceAnalysis a(input({2, 2, 1}), first, pool_);
  SpaceAnalysis b(input({6, 1, 2}), second, pool_);
  SpaceAnalysis closet(input({9, 2, 1}), third, pool_);
  a.skeleton(), b.skeleton(), closet.skeleton();
  using enum ArtefactRecord::Origin;
  EXPECT_EQ(types(second, built), (std::multiset<std::string>{"domain"}));
  EXPECT_EQ(types(third, built), (std::multiset<std::string>{"domain", "skeleton"}));
  EXPECT_NE(closet.skeleton().corners, a.skeleton().corners);
}

TEST_F(SpaceAnalysisTest, TellsSettingsApartInTheCache) {
  const auto built_with = [&](auto change) {
    SpaceInput changed = input({2, 2, 1});
    change(changed.settings);
    ArtefactStore s = store();
    SpaceAnalysis space(std::move(changed), s, pool_);
    space.filtered(), space.gates();
    return std::tuple{types(s, ArtefactRecord::Origin::built), space.skeleton().radii};
  };
  using Types = std::multiset<std::string>;
  const auto [first, corner] = built_with([](AnalysisSettings&) {});
  EXPECT_EQ(first.size(), 7u);
  const auto [again, voxel] =
      built_with([](AnalysisSettings& s) { s.node_radius = NodeRadius::voxel; });
  EXPECT_EQ(again, (Types{"skeleton", "filtered_skeleton", "simplified_skeleton",
                          "visibility_clusters", "visibility_gates"}));
  ASSERT_EQ(voxel.size(), corner.size());
  EXPECT_NE(voxel, corner);
  for (std::size_t n = 0; n < voxel.size(); ++n) EXPECT_GE(voxel[n], std::max(1.0F, corner[n]));
  const auto [third, chessboard] =
      built_with([](AnalysisSettings& s) { s.node_radius = NodeRadius::chessboard; });
  EXPECT_EQ(third, again);
  ASSERT_EQ(chessboard.size(), voxel.size());
  for (std::size_t n = 0; n < voxel.size(); ++n) {  // D_infinity <= D_2
    EXPECT_LE(chessboard[n], voxel[n]);
    EXPECT_EQ(chessboard[n], std::floor(chessboard[n]));
  }
  const auto [wide, same] = built_with([](AnalysisSettings& s) { s.cluster_alpha = 1; });
  EXPECT_EQ(wide, (Types{"visibility_clusters", "visibility_gates"}));
  EXPECT_EQ(same, corner);
  SpaceInput flat = input({2, 2, 1});
  flat.settings.regions = RegionLabelling::openings;
  ArtefactStore first_store = store(), second_store = store();
  SpaceAnalysis forest(input({2, 2, 1}), first_store, pool_),
      openings(std::move(flat), second_store, pool_);
  EXPECT_GE(openings.regions().regions.size(), forest.regions().regions.size());
  EXPECT_EQ(types(second_store, ArtefactRecord::Origin::built), (Types{"regions"}));
  EXPECT_THROW(built_with([](AnalysisSettings& s) { s.cluster_alpha = 2; }), std::invalid_argument);
}

TEST_F(SpaceAnalysisTest, RefusesWhatMemoryCannotHold) {
  ArtefactStore s = store();
  SpaceInput tight = input({2, 2, 1}, 1024);
  tight.byte_limit = [] { return std::uint64_t{1} << 20; };
  SpaceAnalysis space(std::move(tight), s, pool_);
  EXPECT_THROW(space.skeleton(), MemoryLimitError);
}

}  // namespace
}  // namespace lacuna
