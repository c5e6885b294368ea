#include "renderer/scene/nested_solids.h"

#include <gtest/gtest.h>

#include "tests/renderer/scene/scene_parts.h"

namespace lacuna {
namespace {

/// A box of `outer` around one of `inner`, which is at `x`, and an opaque one in both.
SceneData boxes(const Material& outer, const Material& inner, float x) {
  test::SceneParts p;
  p.box({-2, -2, -2}, {2, 2, 2}, true, p.material(outer));
  p.box({x - 1, -1, -1}, {x + 1, 1, 1}, true, p.material(inner));
  p.box({x - 0.5F, -0.5F, -0.5F}, {x + 0.5F, 0.5F, 0.5F}, true,
        p.material(test::diffuse(Rgb(0.5F))));
  p.eye({0, 0, 1.5}, {0, 0, 0}, 1);
  return std::move(p.data);
}
std::vector<std::string> warnings_of_boxes(const Material& outer, const Material& inner, float x) {
  return nested_solids(test::lit_scene(boxes(outer, inner, x)));
}

Material absorbing(Material m) {
  m.extensions.volume.inside.extinction = Rgb(1, 2, 3);
  return m;
}

TEST(NestedSolids, AreWarnedOf) {
  const auto said = warnings_of_boxes(test::glass(), test::glass(), 0);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(said[0].starts_with("6 transmitting meshes lie in other solids")) << said[0];
}

TEST(NestedSolids, OthersAreNot) {
  EXPECT_TRUE(warnings_of_boxes(test::glass(), test::glass(), 5).empty()) << "side by side";
  EXPECT_TRUE(warnings_of_boxes(test::glass(), test::window(), 0).empty());
  EXPECT_TRUE(warnings_of_boxes(test::glass(), test::metal(Rgb(0.9F), 0.2F), 0).empty());
}

TEST(NestedSolids, MeshesThatSolidsAbsorbAround) {
  const auto said = warnings_of_boxes(absorbing(test::glass()), test::metal(Rgb(0.9F), 0.2F), 0);
  ASSERT_EQ(said.size(), 1U);
  EXPECT_TRUE(said[0].starts_with("12 meshes lie in solids that absorb")) << said[0];
}

TEST(NestedSolids, TheCameraInOne) {
  const auto said = [](const Material& m) {
    SceneData data = boxes(m, test::metal(Rgb(0.9F), 0.2F), 0);
    const Camera camera(data.cameras.front(), 8, 8);
    return camera_in_solid(test::lit_scene(std::move(data)), camera).size();
  };
  EXPECT_EQ(said(absorbing(test::glass())), 1U);
  EXPECT_EQ(said(test::glass()), 0U);
}

}  // namespace
}  // namespace lacuna
