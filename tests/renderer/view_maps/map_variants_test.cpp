// Maps without fusion (Kol et al. 2018, 3.2.5), and large splats in coarser levels (3.2.4).

#include <gtest/gtest.h>

#include "renderer/core/rng.h"
#include "renderer/view_maps/view_queue.h"

namespace lacuna {
namespace {

struct ScatteredViews {
  Octree scene;
  ViewTree views;

  static ScatteredViews of(int leaves, int levels, int views, std::uint32_t seed) {
    Rng rng(seed, 0, 0, Rng::Purpose::test);
    std::vector<std::uint64_t> codes;
    for (int i = 0; i < leaves; ++i) {
      codes.push_back(rng.next_u32() % (std::uint64_t{1} << (3 * levels)));
    }
    std::sort(codes.begin(), codes.end());
    codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
    std::vector<View> all;
    for (int i = 0; i < views; ++i) {
      const V3f x(rng.next(), rng.next(), rng.next());
      const V3f n(rng.next() - 0.5F, rng.next() - 0.5F, rng.next() - 0.5F);
      all.push_back({x, n.normalized()});
    }
    return {build_octree(codes, levels, V3d(0.0), 1), ViewTree(all, levels, V3d(0.0), 1)};
  }
};

std::vector<std::vector<float>> fused(const ScatteredViews& s, const ManyViewsSettings& settings,
                                      ManyViewsCounts* counts = nullptr) {
  std::vector<std::vector<float>> maps(s.views.leaf_count());
  const ThreadPool pool(2);
  const ManyViewsCounts told = render_views(SceneNodes(s.scene, pool), s.views, settings, pool,
                                            [&](std::uint32_t leaf, std::span<const float> depths) {
                                              maps[leaf].assign(depths.begin(), depths.end());
                                            });
  if (counts != nullptr) *counts = told;
  return maps;
}

/// Number of nodes with several children, or none, from the root to a leaf.
std::uint64_t maps_above(const Octree& tree, std::uint32_t leaf) {
  const std::uint32_t target = tree.first[tree.first.size() - 2] + leaf;
  std::uint64_t n = 0;
  for (std::uint32_t node = 0;;) {
    const Octree::Node& at = tree.nodes[node];
    n += at.children != 1;
    if (node == target) return n;
    // The last child that does not begin after the target; children of a level are in order.
    for (std::uint32_t c = at.children; c-- > 0;) {
      std::uint32_t first = at.first_child + c;
      while (tree.nodes[first].children > 0) first = tree.nodes[first].first_child;
      if (first > target) continue;
      node = at.first_child + c;
      break;
    }
  }
}

TEST(UnfusedMaps, AnswerAsFusedOnes) {
  const auto s = ScatteredViews::of(2000, 6, 500, 71);
  const ThreadPool pool(2);
  const SceneNodes scene(s.scene, pool);
  for (const bool share : {true, false}) {
    const ManyViewsSettings settings{.cover = 0.8F, .share = share};
    const auto expected = fused(s, settings);
    ManyViewsCounts counts;
    const UnfusedMaps maps = render_unfused(scene, s.views, settings, pool, counts);
    EXPECT_EQ(counts.fusion_seconds, 0);
    std::uint64_t most = 0, filled = 0;
    for (std::uint32_t leaf = 0; leaf < s.views.leaf_count(); ++leaf) {
      const std::uint64_t above = share ? maps_above(s.views.tree(), leaf) : 1;
      most = std::max(most, above);
      for (int t = 0; t < 512; ++t) {
        std::uint64_t read = 0;
        ASSERT_EQ(maps.distance(leaf, t, read), expected[leaf][static_cast<std::size_t>(t)]);
        ASSERT_EQ(read, above);
        filled += std::isfinite(expected[leaf][static_cast<std::size_t>(t)]);
      }
    }
    EXPECT_GT(filled, 10000U);
    EXPECT_EQ(most > 3, share);
  }
}

// A splat of level l fills the block of 2^l texels around it, unless something is nearer.
TEST(MipSplats, FillBlocksOfTexels) {
  for (const int size : {8, 16, 21}) {
    const Paraboloid map{size};
    std::vector<float> depths(static_cast<std::size_t>(map.texels()), 50.0F), expected = depths;
    MipSplats mips(map);
    Rng rng(5, 0, 0, Rng::Purpose::test);
    EXPECT_EQ(mips.push(depths), 0U) << "nothing was drawn";
    for (const int splats : {6, 1}) {  // the levels are empty again after the first push
      for (int n = 0; n < splats; ++n) {
        const float x = (rng.next() * 0.999F) * float(size), y = rng.next() * 0.999F * float(size);
        const Paraboloid::TexelCoord p{n % 2, x, y};
        const float width = n == 0 ? 0.5F : 1 + 9 * rng.next(), distance = 100 * rng.next();
        mips.splat(p, width, distance, depths);
        int block = 1;
        while (float(block) < width && block < size) block *= 2;
        for (int v = 0; v < size; ++v) {
          for (int u = 0; u < size; ++u) {
            if (u / block != int(x) / block || v / block != int(y) / block) continue;
            float& depth = expected[static_cast<std::size_t>(map.index(p.half, u, v))];
            depth = std::min(depth, distance);
          }
        }
      }
      mips.push(depths);
      EXPECT_EQ(depths, expected) << size;
    }
    EXPECT_LT(*std::min_element(depths.begin(), depths.end()), 50);
  }
}

TEST(MipSplats, AreTheSameBreadthFirstAndForFewTexels) {
  const auto s = ScatteredViews::of(3000, 5, 300, 72);
  for (const bool share : {true, false}) {
    ManyViewsSettings settings{.map_size = 64, .share = share};
    ManyViewsCounts texels, mips, queue;
    const auto filled = fused(s, settings, &texels);
    settings.mips = true;
    const auto splatted = fused(s, settings, &mips);
    settings.breadth_first = true;
    EXPECT_EQ(fused(s, settings, &queue), splatted);
    EXPECT_EQ(mips.large, texels.large);
    EXPECT_GT(mips.large, 1000U);
    EXPECT_EQ(mips.filled, queue.filled);
    EXPECT_NE(splatted, filled);
  }
}

}  // namespace
}  // namespace lacuna
