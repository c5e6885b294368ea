// Lights whose maps do not fit into memory are treated in passes: the picture is that of one.

#include <gtest/gtest.h>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/integrators/methods.h"
#include "tests/renderer/integrators/render.h"

namespace lacuna {
namespace {

double statistic(const Integrator& integrator, std::string_view name) {
  for (const auto& [key, value] : integrator.statistics()) {
    if (key == name) return value;
  }
  ADD_FAILURE() << name;
  return 0;
}

struct Lit {
  const char* scene;
  GatherSettings gather;
  DirectLighting direct;
};

TEST(LightPasses, MakeThePictureOfOne) {
  const RandomLightsSettings few{.lights = 30};
  const RandomLightsSettings smooth{.lights = 30, .filter_radius = 2};
  for (const Lit& lit : {Lit{"cornell.glb", AllLightsSettings{}, DirectLighting::next_event},
                         Lit{"glass.glb", AllLightsSettings{}, DirectLighting::lights},
                         Lit{"mirror.glb", few, DirectLighting::lights},
                         Lit{"ajar.glb", smooth, DirectLighting::next_event}}) {
    // Each light by itself, so that its map does not depend on who else is there.
    ManyLightsSettings s =
        test::lit_by(5, 400, ViewMapsVisibilitySettings{.method = ViewMapMethod::per_view});
    auto& maps = std::get<ViewMapsVisibilitySettings>(s.visibility);
    maps.levels = 11;
    s.gather = lit.gather;
    s.direct = lit.direct;
    std::array<Image, 2> pictures;
    std::array<double, 2> passes{}, leaves{};
    std::array<Counters, 2> counters;
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      maps.memory = k == 0 ? 4 : 0.0001;
      test::Session session(load_gltf(test::own_scene(lit.scene)),
                            {.integrator = s, .width = 40, .height = 30});
      pictures[k] = session.iterate(0);
      passes[k] = statistic(session.integrator(), "view_passes");
      leaves[k] = statistic(session.integrator(), "view_leaves");
      counters[k] = session.counters();
    }
    EXPECT_EQ(passes[0], 1) << lit.scene;
    EXPECT_GT(passes[1], 2) << lit.scene;
    EXPECT_NEAR(leaves[0], leaves[1], 0.02 * leaves[0]) << lit.scene;
    EXPECT_EQ(counters[0].samples, counters[1].samples);
    EXPECT_EQ(counters[0].shadow_rays, counters[1].shadow_rays) << lit.scene;
    int different = 0;
    double sum = 0;
    for (std::size_t i = 0; i < pictures[0].pixels.size(); ++i) {
      const Rgb &a = pictures[0].pixels[i], &b = pictures[1].pixels[i];
      different += (a - b).length() > 1e-5F * (a.length() + b.length());
      sum += double(a.length());
    }
    EXPECT_GT(sum, 0);
    // Lights of two passes may have met in one leaf.
    EXPECT_LT(different, 12) << lit.scene;
  }
}

}  // namespace
}  // namespace lacuna
