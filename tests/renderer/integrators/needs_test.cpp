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

}  // namespace
}  // namespace lacuna
