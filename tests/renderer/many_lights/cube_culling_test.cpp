// Lights that are culled for cubes of the scene, against every light by itself.

#include "renderer/many_lights/cube_culling.h"

#include <set>

#include "renderer/many_lights/vpl_sampler.h"
#include "tests/renderer/many_lights/sampled_means.h"

namespace lacuna {
namespace {

using test::expect_means_of_all;
using test::LitScene;

TEST(CubeCulling, KeepsWhatALightMayIlluminate) {
  for (const char* scene : {"ajar", "atrium", "many_lights", "open"}) {
    LitScene lit({scene, std::string_view(scene) == "open"}, 500, 2);
    const auto octree = lit.space().octree(CubeCulling::levels);
    for (const float cutoff : {0.0F, 0.5F}) {
      const CubeCulling cubes(lit.lights(), *octree, cutoff, lit.pool());
      std::set<std::uint32_t> all;
      for (std::size_t l = 0; l < cubes.leaves(); ++l) {
        for (const std::uint32_t light : cubes.lights_of(l)) EXPECT_TRUE(all.insert(light).second);
      }
      EXPECT_EQ(all.size(), lit.lights().size());
      std::size_t inside = 0, left_out = 0, missed = 0;
      lit.with_points(500, [&](std::span<const ShadingPoint> points) {
        Terms terms;
        for (const ShadingPoint& p : points) {
          const V3f x = p.vertex->surface.x;
          const auto bits = cubes.left(x);
          if (!bits) continue;
          ++inside;
          std::vector<bool> kept(all.size(), false);
          std::size_t left = 0;
          for (std::size_t l = 0; l < cubes.leaves(); ++l) {
            if (((*bits)[l / 64] >> l % 64 & 1) == 0) continue;
            for (const std::uint32_t light : cubes.lights_of(l)) kept[light] = true, ++left;
          }
          left_out += all.size() - left;
          std::uint32_t n = 0;
          for (std::size_t b = 0; b < lit.lights().blocks(); ++b) {
            lit.terms().evaluate(p, b, terms);
            for (int i = 0; i < lit.lights().count(b); ++i, ++n) {
              const VplGeometry light = lit.lights().geometry(b, i);
              const bool near = cutoff == 0 || light.infinite || (light.x - x).length() <= cutoff;
              const bool lit_here = near && (terms.lit >> i & 1) != 0;
              missed += lit_here && !kept[n];
            }
          }
        }
      });
      EXPECT_EQ(missed, 0U) << scene;
      EXPECT_GT(inside, 5U) << scene;
      if (std::string_view(scene) == "ajar" || std::string_view(scene) == "atrium") {
        EXPECT_GT(left_out, 1000U) << scene;
        EXPECT_GT(cubes.culled(), 0.05) << scene;
      }
    }
  }
}

// The traversal of both trees leaves the pairs that are left where each pair of leaves is tested.
TEST(CubeCulling, TestsFewerPairsThanLeavesHave) {
  LitScene lit({"ajar"}, 2000, 2);
  const auto octree = lit.space().octree(CubeCulling::levels);
  const CubeCulling cubes(lit.lights(), *octree, 0.3F, lit.pool());
  EXPECT_LT(double(cubes.pairs()), double(octree->leaves().size()) * double(cubes.leaves()));
  EXPECT_GT(cubes.culled(), 0.5);
}

TEST(CubeCulling, OfNoLightsIsNothing) {
  LitScene lit({"ajar"}, 1, 2, false);
  const VplSet none(1, {1, false, 0.1F});
  const auto octree = lit.space().octree(CubeCulling::levels);
  const CubeCulling cubes(none, *octree, 0, lit.pool());
  EXPECT_EQ(cubes.leaves(), 1U);
  EXPECT_TRUE(cubes.lights_of(0).empty());
}

TEST(CubeCulling, LeavesSampledSumsTheirMean) {
  for (const char* scene : {"ajar", "coated_points"}) {
    LitScene lit({scene}, 200, 2);
    const auto octree = lit.space().octree(CubeCulling::levels);
    const CubeCulling cubes(lit.lights(), *octree, 0, lit.pool());
    expect_means_of_all(lit, {.lights = 20}, &cubes);
  }
}

TEST(InterleavedLights, HaveTheMeanOfAll) {
  for (const bool cull : {true, false}) {
    expect_means_of_all(LitScene({"ajar"}, 200, 2), {.interleave = 4, .cull = cull});
  }
}

// Without culling, the pixels of a pattern take every light once.
TEST(InterleavedLights, AreSharedOutAmongPixels) {
  const LitScene lit({"ajar"}, 500, 2);
  std::set<std::pair<std::size_t, int>> all;
  std::size_t sampled = 0, pixels = 0;
  VplSampler sampler(lit.terms(), {.interleave = 2, .cull = false});
  lit.with_points(0, [&](std::span<const ShadingPoint> points) {
    for (const ShadingPoint& p : points) {
      if (p.pixel % 40 >= 2 || p.depth > 1) continue;  // of a column of patterns
      ++pixels;
      for (const auto& s : sampler.sample(std::span(&p, 1), lit.context(1))) {
        EXPECT_EQ(s.weight, 4.0F);
        for_each_bit(s.lights, [&](int i) { all.emplace(s.block, i), ++sampled; });
      }
    }
  });
  ASSERT_EQ(pixels, 4U) << "the first pattern: pixels 0, 1, 40 and 41";
  EXPECT_EQ(sampled, lit.lights().size());
  EXPECT_EQ(all.size(), sampled);
}

}  // namespace
}  // namespace lacuna
