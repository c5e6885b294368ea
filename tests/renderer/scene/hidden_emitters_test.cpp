#include "renderer/scene/hidden_emitters.h"

#include <gtest/gtest.h>

#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

/// A wall in the plane z = 0 and a square lamp in front of it at z = `distance`, `lamps` times.
/// `mirrored`: the later ones face the wall.
test::GlbBuilder wall_and_lamp(float distance, int lamps = 1, bool mirrored = false) {
  test::GlbBuilder b;
  const auto wall = b.add_material({{"name", "plaster"}});
  const auto lamp = b.add_material({{"name", "lamp"}, {"emissiveFactor", {1, 1, 1}}});
  b.add_node(
      {{"name", "wall"}, {"mesh", b.add_quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, int(wall))}});
  const V3f o(0.3F, 0.2F, distance), x(1, 0, 0), y(0, 1, 0);
  for (int i = 0; i < lamps; ++i) {
    const bool back = mirrored && i > 0;
    const auto mesh = b.add_quad(o, back ? y : x, back ? x : y, static_cast<int>(lamp));
    b.add_node({{"name", "lamp"}, {"mesh", mesh}});
  }
  return b;
}

std::vector<std::string> warnings(const test::GlbBuilder& builder) {
  const ThreadPool pool(1);
  return hidden_emitters({test::load(builder), {.emission = true}, std::nullopt, pool});
}

TEST(HiddenEmitters, ALampInAWallIsWarnedOf) {
  for (const float distance : {0.0F, -1e-7F, -1e-6F, -1e-3F, -0.1F}) {
    const auto said = warnings(wall_and_lamp(distance));
    // Deeper in the wall, it is hidden for every method.
    ASSERT_EQ(said.size(), distance < -1e-5F ? 0U : 1U) << distance;
    if (!said.empty()) {
      EXPECT_NE(said[0].find("\"lamp\" by \"wall\""), std::string::npos) << said[0];
    }
  }
  for (const float distance : {1e-6F, 1e-3F, 1.0F}) {
    EXPECT_TRUE(warnings(wall_and_lamp(distance)).empty()) << distance;
  }
}

TEST(HiddenEmitters, LampsBackToBackAreWarnedOf) {
  EXPECT_EQ(warnings(wall_and_lamp(1, 2, true)).size(), 1U);
}

TEST(EqualEmitters, AreMerged) {
  const SceneData one = test::load(wall_and_lamp(1));
  const SceneData three = test::load(wall_and_lamp(1, 3));
  EXPECT_EQ(three.triangle_count(), one.triangle_count());
  EXPECT_EQ(three.geometry_hash, one.geometry_hash);
  ASSERT_EQ(three.warnings.size(), 1U);
  EXPECT_TRUE(three.warnings[0].starts_with("4 emitting triangles lie exactly on others"));
  EXPECT_NE(three.warnings[0].find("\"lamp\", on \"lamp\""), std::string::npos);
  EXPECT_TRUE(one.warnings.empty());
}

TEST(EqualEmitters, DifferInMaterialOrSide) {
  EXPECT_EQ(test::load(wall_and_lamp(1, 2, true)).triangle_count(), 6U);
  test::GlbBuilder b = wall_and_lamp(1, 2);
  b.json["materials"].push_back({{"emissiveFactor", {1, 0.5, 1}}});
  b.json["meshes"][2]["primitives"][0]["material"] = 2;
  EXPECT_EQ(test::load(b).triangle_count(), 6U);
}

}  // namespace
}  // namespace lacuna
