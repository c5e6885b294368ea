// Rendering a scene's octree into many views at once, against each view by itself and against brute
// force.

#include "renderer/view_maps/many_views.h"

#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "renderer/core/sampling.h"
#include "renderer/view_maps/view_maps.h"
#include "tests/renderer/view_maps/random_views.h"

namespace lacuna {
namespace {

using test::Facing;
using test::random_direction;
using test::random_tree;
using test::random_views;

constexpr float nothing = std::numeric_limits<float>::infinity();

using Maps = std::vector<std::vector<float>>;

Maps maps_of(const Octree& scene, const ViewTree& views, const ManyViewsSettings& settings,
             int threads = 2, ManyViewsCounts* counts = nullptr) {
  Maps maps(views.leaf_count());
  const SceneNodes nodes(scene, ThreadPool(threads));
  const auto told = render_views(nodes, views, settings, ThreadPool(threads),
                                 [&](std::uint32_t leaf, std::span<const float> depths) {
                                   maps[leaf].assign(depths.begin(), depths.end());
                                 });
  if (counts != nullptr) *counts = told;
  for (const auto& m : maps) {
    EXPECT_EQ(m.size(), std::size_t{2} * static_cast<std::size_t>(settings.map_size) *
                            static_cast<std::size_t>(settings.map_size));
  }
  return maps;
}

TEST(ManyViews, FillWhatALeafCovers) {
  const std::vector<std::uint64_t> codes{0};
  const Octree voxel = build_octree(codes, 3, V3d(0.0), 1);
  const V3f middle = voxel.leaves()[0].centre;
  Rng rng(8, 0, 0, Rng::Purpose::test);
  for (const int size : {8, 16, 21, 64}) {
    const Paraboloid map{size};
    int filled = 0, within = 0;
    for (int n = 0; n < 40; ++n) {
      const V3f x = middle + random_direction(rng) * (0.05F + 0.3F * rng.next());
      const V3f d = middle - x;
      const std::vector<View> view{{x, V3f(0.0F)}};
      ManyViewsCounts counts;
      const Maps maps = maps_of(voxel, ViewTree(view, 3, V3d(0.0), 1),
                                {.map_size = size, .cover = 0.7F}, 1, &counts);
      if (counts.large == 0) continue;
      const float sine = 0.7F * voxel.radius(3) / d.length();
      const float cosine = sine < 1 ? std::sqrt(1 - sine * sine) : 0;
      const bool inside = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) < 1.0F / 16;
      within += inside;
      for (int t = 0; t < map.texels(); ++t) {
        const float off = map.direction(t).dot(d.normalized()) - cosine;
        if (std::abs(off) < 1e-4F || map.coord(map.direction(t)).half != t / (size * size))
          continue;
        const float shown = maps[0][static_cast<std::size_t>(t)];
        const bool covered = off > 0 && !inside;
        EXPECT_EQ(shown < nothing, covered) << t << " of " << size;
        if (covered) {
          EXPECT_NEAR(shown, d.length(), 1e-5);
        }
        filled += covered;
      }
    }
    EXPECT_GT(filled, 100);
    EXPECT_GT(within, 0);
  }
}

TEST(ViewTree, SpheresAndConesHoldAllViewsBelow) {
  for (const Facing facing : {Facing::everywhere, Facing::anywhere, Facing::alike}) {
    const auto views = random_views(300, facing, 4);
    const ViewTree tree(views, 4, V3d(0.0), 1);
    for (std::size_t i = 0; i < views.size(); ++i) {
      // The leaf, and all above it.
      std::uint32_t node = tree.first_leaf() + tree.leaf_of(i);
      for (;;) {
        const ViewTree::Node& v = tree.node(node);
        EXPECT_LE((views[i].x - v.centre).length(), v.radius + 1e-6F);
        if (views[i].n == V3f(0.0F)) {
          EXPECT_EQ(v.cosine, -1);
        } else if (v.cosine > -1) {
          const float own = std::acos(std::clamp(v.n.dot(views[i].n), -1.0F, 1.0F));
          EXPECT_GE(std::acos(v.cosine), own + pi / 2);
        }
        if (node == 0) break;
        std::uint32_t parent = 0;
        while (node < tree.tree().nodes[parent].first_child ||
               node >= tree.tree().nodes[parent].first_child + tree.tree().nodes[parent].children) {
          ++parent;
        }
        node = parent;
      }
    }
  }
}

// Views at one place with different facings part at a level of cubes, and come together above it.
TEST(ViewTree, PartsViewsByFacing) {
  const V3f x(0.3F, 0.4F, 0.5F);
  const std::vector<View> views{{x, V3f(0, 0, 1)},         {x, V3f(0, 0, -1)},
                                {x, V3f(1, 0, 0)},         {x, V3f(0.5F, 0, 0.8660254F)},
                                {x, V3f(0, -1, 0)},        {x, V3f(0.0F)},
                                {V3f(0.31F), V3f(0, 0, 1)}};
  for (const int levels : {3, 9, Octree::most_levels - 1}) {
    const ViewTree parted(views, levels, V3d(0.0), 1);
    EXPECT_EQ(parted.leaf_of(0), parted.leaf_of(3)) << "both up";
    for (const std::size_t i : {1, 2, 4, 5}) {
      for (std::size_t k = 0; k < i; ++k) EXPECT_NE(parted.leaf_of(i), parted.leaf_of(k)) << i;
    }
    const auto level = static_cast<std::size_t>(std::min(levels, ViewTree::facing_level));
    const auto nodes = [&](std::size_t l) {
      return parted.tree().first[l + 1] - parted.tree().first[l];
    };
    EXPECT_EQ(nodes(level), 2U);  // of the two places
    EXPECT_EQ(nodes(level + 1), 6U);
    EXPECT_EQ(parted.node(0).views, views.size());
    const ViewTree together(views, levels, V3d(0.0), 1, ViewTree::Split::position);
    EXPECT_EQ(together.leaf_count(), 2U);
  }
}

// What a view may see is never culled, whatever node it is culled for: by spheres, which also are
// what nodes are rendered as. (By boxes some are culled whose spheres alone are seen, see
// view_pairs_test.cpp.)
TEST(ManyViews, CullOnlyWhatNoViewSees) {
  for (const Facing facing : {Facing::anywhere, Facing::alike, Facing::everywhere}) {
    const Octree scene = random_tree(400, 4, 11);
    const auto views = random_views(60, facing, 12);
    const ViewTree tree(views, 4, V3d(0.0), 1);
    ManyViewsCounts counts;
    const Maps culled = maps_of(scene, tree, {.cull = true, .boxes = false}, 2, &counts);
    const Maps all = maps_of(scene, tree, {.cull = false});
    const Paraboloid map{16};
    for (std::size_t i = 0; i < views.size(); ++i) {
      const std::uint32_t leaf = tree.leaf_of(i);
      for (int t = 0; t < map.texels(); ++t) {
        const V3f w = map.direction(t);
        // A node behind the plane may have its centre in a texel that the plane crosses.
        const float half_diagonal = std::sqrt(0.5F) / map.stretch(std::abs(w.x));
        if (w.dot(views[i].n) < std::sin(half_diagonal) && views[i].n != V3f(0.0F)) continue;
        EXPECT_EQ(culled[leaf][static_cast<std::size_t>(t)],
                  all[leaf][static_cast<std::size_t>(t)]);
      }
    }
    EXPECT_EQ(counts.culled > 0, facing != Facing::everywhere);
  }
}

// Each view by itself: the nearest leaf of those whose centre falls into a texel, within what the
// traversal may be off: a texel, and a node that shows less than one.
TEST(ManyViews, SeeTheNearestLeaf) {
  const Octree scene = random_tree(300, 5, 21);
  const auto views = random_views(40, Facing::everywhere, 22);
  const ViewTree tree(views, 5, V3d(0.0), 1);
  const Paraboloid map{16};
  for (const bool share : {false, true}) {
    const Maps maps = maps_of(scene, tree, {.share = share});
    std::size_t compared = 0, wrong = 0;
    for (std::uint32_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
      const V3f from = tree.node(tree.first_leaf() + leaf).centre;
      for (const Octree::Node& s : scene.leaves()) {
        const V3f d = s.centre - from;
        // Its own texel shows it or something as near, up to the size of its largest stand-in.
        const float shown = maps[leaf][static_cast<std::size_t>(map.texel(d))];
        ++compared;
        wrong += !(shown <= d.length() * 1.15F + 2 * scene.radius(5));
      }
    }
    EXPECT_GT(compared, 9000U);
    // Across a texel's border a stand-in, or a shared place, may fall into the next texel.
    EXPECT_LT(double(wrong), (share ? 0.12 : 0.08) * double(compared)) << share;
  }
}

TEST(ManyViews, SharedOrNotAreAlike) {
  const Octree scene = random_tree(3000, 6, 31);
  // Views near one another, which share much.
  auto views = random_views(400, Facing::alike, 32);
  for (View& v : views) v.x = V3f(0.4F) + v.x * 0.1F;
  const ViewTree tree(views, 7, V3d(0.0), 1);
  ManyViewsCounts together, apart;
  const Maps a = maps_of(scene, tree, {.share = true}, 2, &together);
  const Maps b = maps_of(scene, tree, {.share = false}, 2, &apart);
  std::size_t texels = 0, different = 0;
  for (std::size_t leaf = 0; leaf < a.size(); ++leaf) {
    for (std::size_t t = 0; t < a[leaf].size(); ++t) {
      const float x = a[leaf][t], y = b[leaf][t];
      if (x == nothing && y == nothing) continue;
      ++texels;
      different += !(std::abs(x - y) <= 0.05F * y);
    }
  }
  EXPECT_LT(double(different), 0.3 * double(texels)) << different << " of " << texels;
  EXPECT_LT(together.splats, apart.splats);
  EXPECT_GT(double(together.sharing) / double(together.splats), 1.5);
  // Apart, only the views of a leaf share.
  EXPECT_LT(double(apart.sharing), 1.2 * double(apart.splats));
  EXPECT_LT(together.queue_peak(), apart.queue_peak());
}

// What is rendered for many views at once lies at each one's own distance (3.2.5).
TEST(ManyViews, HandDownDistancesFromEachView) {
  const std::vector<std::uint64_t> far_corner{63};
  const Octree scene = build_octree(far_corner, 2, V3d(0.0), 1);
  auto views = random_views(50, Facing::everywhere, 45);
  for (View& v : views) v.x = V3f(0.1F) + 0.15F * v.x;
  const ViewTree tree(views, 11, V3d(0.0), 1);
  ManyViewsCounts counts;
  const Maps maps = maps_of(scene, tree, {.map_size = 8, .node_texels = 2}, 2, &counts);
  ASSERT_EQ(counts.splats, 1U);
  ASSERT_EQ(counts.sharing, tree.leaf_count());
  double off = 0, steps = 0;  // squares
  for (std::uint32_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    const V3f x = tree.node(tree.first_leaf() + leaf).centre;
    const float shown = *std::min_element(maps[leaf].begin(), maps[leaf].end());
    off += std::pow(shown - (scene.leaves()[0].centre - x).length(), 2);
    steps += (x - tree.node(0).centre).length2();
  }
  // A third would be that of the distance from their middle; what remains is a texel's width.
  EXPECT_LT(off, 0.1 * steps);
}

TEST(ManyViews, AreTheSameForAnyNumberOfThreads) {
  const Octree scene = random_tree(500, 5, 41);
  const ViewTree tree(random_views(700, Facing::anywhere, 42), 5, V3d(0.0), 1);
  for (const bool share : {true, false}) {
    ManyViewsCounts one, two;
    EXPECT_EQ(maps_of(scene, tree, {.share = share}, 1, &one),
              maps_of(scene, tree, {.share = share}, 2, &two));
    EXPECT_EQ(one.pairs, two.pairs);
    EXPECT_EQ(one.generations, two.generations);
  }
}

// The pairs of a breadth-first traversal, a generation after another.
TEST(ManyViews, CountWhatAQueueWouldHold) {
  const Octree scene = random_tree(50, 3, 51);
  const ViewTree tree(random_views(30, Facing::anywhere, 52), 3, V3d(0.0), 1);
  ManyViewsCounts counts;
  maps_of(scene, tree, {}, 1, &counts);
  std::uint64_t sum = 0;
  for (const std::uint64_t n : counts.generations) sum += n;
  EXPECT_EQ(sum, counts.pairs);
  EXPECT_EQ(counts.generations[0], 1U);
}

// The queue of the paper: the same pairs, and so the same maps bit by bit.
TEST(ManyViews, AreTheSameBreadthFirst) {
  const Octree scene = random_tree(2000, 6, 71);
  const ViewTree tree(random_views(500, Facing::anywhere, 72), 6, V3d(0.0), 1);
  for (const bool share : {true, false}) {
    ManyViewsCounts deep, wide, wide_alone;
    const ManyViewsSettings settings{.cover = share ? 0.8F : 0, .share = share};
    ManyViewsSettings by_queue = settings;
    by_queue.breadth_first = true;
    const Maps expected = maps_of(scene, tree, settings, 2, &deep);
    EXPECT_EQ(maps_of(scene, tree, by_queue, 2, &wide), expected);
    EXPECT_EQ(maps_of(scene, tree, by_queue, 1, &wide_alone), expected);
    EXPECT_EQ(wide.generations, deep.generations);
    EXPECT_EQ(wide.sharing, deep.sharing);
    EXPECT_EQ(wide.queue_bytes, wide_alone.queue_bytes);
    // A generation and the next; sixteen bytes a pair.
    EXPECT_GE(wide.queue_bytes, deep.queue_peak() * 16);
    EXPECT_LE(wide.queue_bytes, 2 * deep.queue_peak() * 16);
    const std::size_t maps = share ? tree.tree().nodes.size() : tree.leaf_count();
    EXPECT_EQ(wide.unfused_bytes, maps * (512 + 8) * sizeof(float));
    EXPECT_EQ(deep.queue_bytes + deep.unfused_bytes, 0U);
  }
}

// No node stands for others: each leaf is in the texel that its middle falls into.
TEST(ManyViews, WithoutMergingShowEveryLeaf) {
  const Octree scene = random_tree(300, 5, 21);
  const ViewTree tree(random_views(40, Facing::everywhere, 22), 5, V3d(0.0), 1);
  const Paraboloid map{16};
  ManyViewsCounts counts;
  const Maps maps = maps_of(scene, tree, {.share = false, .merge = false}, 2, &counts);
  for (std::uint32_t leaf = 0; leaf < tree.leaf_count(); ++leaf) {
    const V3f from = tree.node(tree.first_leaf() + leaf).centre;
    for (const Octree::Node& s : scene.leaves()) {
      const V3f d = s.centre - from;
      EXPECT_LE(maps[leaf][static_cast<std::size_t>(map.texel(d))], d.length() * (1 + 1e-5F));
    }
  }
  EXPECT_EQ(counts.splats, scene.leaves().size() * tree.leaf_count());
}

// Memory of earlier maps holds later ones, fewer or more.
TEST(ViewMaps, KeepTheirMemory) {
  ViewMaps maps(8, 100);
  std::size_t bytes = 0;
  for (const std::uint32_t leaves : {100U, 30U, 103U, 400U, 1U}) {
    maps.resize(leaves);
    EXPECT_GE(maps.bytes(), bytes);
    bytes = std::max(bytes, std::size_t{leaves} * 128 * sizeof(std::uint16_t));
    EXPECT_EQ(maps.bytes(), bytes);
    for (std::uint32_t i = 0; i < leaves; ++i) {
      const float distance = i % 3 == 0 ? std::numeric_limits<float>::infinity() : float(i);
      maps.set(i, std::vector<float>(128, distance));
    }
    for (std::uint32_t i = 0; i < leaves; ++i) {
      const float expected = i % 3 == 0 ? 0 : maps.scale() / float(i);
      EXPECT_NEAR(maps.nearness(i, static_cast<int>(i % 128)), expected, expected / 1024);
    }
  }
}

TEST(ManyViews, AtTheirEnds) {
  const Octree empty = build_octree({}, 4, V3d(0.0), 1);
  const Octree scene = random_tree(100, 4, 61);
  const std::vector<View> one{{V3f(0.3F, 0.3F, 0.3F), V3f(0, 0, 1)}};
  // No scene, no view.
  for (const auto& m : maps_of(empty, ViewTree(one, 4, V3d(0.0), 1), {})) {
    EXPECT_TRUE(std::all_of(m.begin(), m.end(), [](float d) { return d == nothing; }));
  }
  EXPECT_TRUE(maps_of(scene, ViewTree({}, 4, V3d(0.0), 1), {}).empty());
  const ManyViewsSettings by_queue{.breadth_first = true};
  EXPECT_EQ(maps_of(empty, ViewTree(one, 4, V3d(0.0), 1), by_queue),
            maps_of(empty, ViewTree(one, 4, V3d(0.0), 1), {}));
  EXPECT_TRUE(maps_of(scene, ViewTree({}, 4, V3d(0.0), 1), by_queue).empty());
  // One voxel, seen from outside, from within, from its very middle, and from a corner of cells.
  const std::vector<std::uint64_t> codes{0};
  const Octree voxel = build_octree(codes, 3, V3d(0.0), 1);
  for (const V3f& x : {V3f(0.9F), V3f(0.1F, 0.05F, 0.02F), V3f(0.0625F), V3f(0.5F), V3f(0.125F)}) {
    const std::vector<View> view{{x, V3f(0.0F)}};
    for (const auto& m : maps_of(voxel, ViewTree(view, 3, V3d(0.0), 1), {})) {
      for (const float d : m) EXPECT_FALSE(std::isnan(d));
      const bool within = std::max({x.x, x.y, x.z}) < 0.125F;
      EXPECT_NE(std::any_of(m.begin(), m.end(), [](float d) { return d < nothing; }), within);
    }
  }
  // All views at one point.
  const std::vector<View> same(1000, one[0]);
  EXPECT_EQ(maps_of(scene, ViewTree(same, 11, V3d(0.0), 1), {}),
            maps_of(scene, ViewTree(one, 11, V3d(0.0), 1), {}));
  // Distances over four decades.
  const Octree deep = random_tree(200, 11, 62);
  const std::vector<View> near{{V3f(deep.leaves()[0].centre) + V3f(2.6e-4F, 0, 0), V3f(0.0F)}};
  for (const auto& m : maps_of(deep, ViewTree(near, 11, V3d(0.0), 1), {})) {
    EXPECT_LT(*std::min_element(m.begin(), m.end()), 3e-4F);
    for (const float d : m) EXPECT_FALSE(std::isnan(d));
  }
}

}  // namespace
}  // namespace lacuna
