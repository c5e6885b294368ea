// Only what the scene and the method require is built.

#include <gtest/gtest.h>

#include "renderer/gltf/gltf_load.h"
#include "tests/renderer/integrators/render.h"

namespace lacuna {
namespace {

using test::render;
using test::Rendering;

InspectSettings show(InspectQuantity q) { return {q}; }

TEST(Needs, PathWithoutTexturesDecodesNoneAndFiltersNothing) {
  const Rendering r = render("cornell.glb", {.iterations = 1});
  EXPECT_EQ(r.textures_decoded, 0);
  EXPECT_EQ(r.filters, 0);
  EXPECT_TRUE(r.emitters_built);
}

TEST(Needs, PathDecodesTexturesAndFiltersMasksOnly) {
  const SceneData atrium = load_gltf(test::own_scene("atrium.glb"));
  int masked = 0;
  for (const Mesh& m : atrium.meshes) masked += atrium.materials[m.material].mask ? 1 : 0;
  ASSERT_GT(masked, 0);
  ASSERT_LT(masked, static_cast<int>(atrium.meshes.size()));
  const Rendering r = render("atrium.glb", {.iterations = 1});
  EXPECT_EQ(r.filters, masked);
  EXPECT_EQ(r.textures_decoded, static_cast<int>(atrium.textures.size()));
}

TEST(Needs, ShapeAloneOpensNothingButMasks) {
  for (const auto q : {InspectQuantity::normal, InspectQuantity::depth}) {
    const Rendering r = render("ajar.glb", {.integrator = show(q), .iterations = 1});
    EXPECT_EQ(r.textures_decoded, 0);
    EXPECT_FALSE(r.emitters_built);
  }
  EXPECT_EQ(render("atrium.glb", {.integrator = show(InspectQuantity::depth), .iterations = 1})
                .textures_decoded,
            1);
}

TEST(Needs, EmissionOpensEmissionTexturesOnly) {
  const Rendering r =
      render("ajar.glb", {.integrator = show(InspectQuantity::emission), .iterations = 1});
  EXPECT_EQ(r.textures_decoded, 0);
  EXPECT_TRUE(r.emitters_built);
}

TEST(Inspect, ShowsWhatItSays) {
  // The floor of `point.glb` seen from straight above: one normal, a known depth in the middle.
  const Rendering normal = render("point.glb", {.integrator = show(InspectQuantity::normal),
                                                .width = 9,
                                                .height = 9,
                                                .iterations = 1,
                                                .camera = "above"});
  const std::vector<double> n = normal.film.mean();
  for (std::size_t i = 0; i < n.size(); i += 3) {
    EXPECT_NEAR(n[i + 1], 1, 1e-6);
    EXPECT_NEAR(n[i], 0, 1e-6);
  }
  const SceneData scene = load_gltf(test::own_scene("point.glb"));
  const double height = scene.cameras.front().to_world[3][1];
  const Rendering depth = render("point.glb", {.integrator = show(InspectQuantity::depth),
                                               .width = 9,
                                               .height = 9,
                                               .iterations = 64,
                                               .camera = "above"});
  EXPECT_NEAR(depth.film.mean()[3 * (4 * 9 + 4)], height, 0.01 * height);
  const Rendering albedo = render("point.glb", {.integrator = show(InspectQuantity::albedo),
                                                .width = 9,
                                                .height = 9,
                                                .iterations = 1,
                                                .camera = "above"});
  for (const double v : albedo.film.mean()) EXPECT_NEAR(v, 0.5, 1e-6);
}

}  // namespace
}  // namespace lacuna
