#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::component_float;
using test::component_s16;
using test::GlbBuilder;

SceneData load_at(const GlbBuilder& builder, const SceneChoice& time) {
  const TemporaryFolder folder;
  return load_gltf(folder.write("scene.glb", builder.glb()), nullptr, time);
}

using Quaternion = std::array<float, 4>;

/// Adds an animation of one channel.
void animate(GlbBuilder& b, std::size_t node, const std::string& path, std::size_t input,
             std::size_t output, const std::string& interpolation, const std::string& name = "") {
  Json sampler{{"input", input}, {"output", output}};
  if (!interpolation.empty()) sampler["interpolation"] = interpolation;
  Json animation{{"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}},
                 {"samplers", {sampler}}};
  if (!name.empty()) animation["name"] = name;
  b.json["animations"].push_back(animation);
}

std::size_t times(GlbBuilder& b, const std::vector<float>& values) {
  return b.add_accessor(values, component_float, "SCALAR");
}

/// Vertex 1 of the triangle, (1, 0, 0) in its node, at a time.
V3f corner(const GlbBuilder& b, double seconds) {
  return load_at(b, {seconds}).meshes.at(0).positions.at(1);
}

TEST(Animation, LinearTranslationIsClampedAtItsEnds) {
  GlbBuilder b = test::triangle_scene();
  b.json["nodes"][0]["translation"] = {0, 9, 0};
  const auto output =
      b.add_accessor(std::vector<V3f>{{0, 0, 0}, {4, 0, 0}, {4, 8, 0}}, component_float, "VEC3");
  animate(b, 0, "translation", times(b, {1, 2, 4}), output, "");
  expect_near(load(b).meshes.at(0).positions[1], {1, 9, 0});
  expect_near(corner(b, 0), {1, 0, 0});
  expect_near(corner(b, 1.25), {2, 0, 0});
  expect_near(corner(b, 2), {5, 0, 0});
  expect_near(corner(b, 3), {5, 4, 0});
  expect_near(corner(b, 100), {5, 8, 0});
}

TEST(Animation, StepKeepsTheKeyBefore) {
  GlbBuilder b = test::triangle_scene();
  const auto output =
      b.add_accessor(std::vector<V3f>{{1, 1, 1}, {3, 1, 1}}, component_float, "VEC3");
  animate(b, 0, "scale", times(b, {1, 2}), output, "STEP");
  expect_near(corner(b, 1.999), {1, 0, 0});
  expect_near(corner(b, 2), {3, 0, 0});
}

TEST(Animation, RotationsAreSlerpedTheShortWay) {
  // From 0 to 120 degrees about z; a third of the time is a third of the angle, unlike in a mean of
  // quaternions. The second key has the sign of the long way.
  const double half = std::numbers::pi / 3;
  const auto z = static_cast<float>(-std::sin(half));
  const auto w = static_cast<float>(-std::cos(half));
  GlbBuilder b = test::triangle_scene();
  const auto output =
      b.add_accessor(std::vector<Quaternion>{{0, 0, 0, 1}, {0, 0, z, w}}, component_float, "VEC4");
  animate(b, 0, "rotation", times(b, {0, 3}), output, "LINEAR");
  const double angle = 2 * std::numbers::pi / 9;
  expect_near(corner(b, 1), V3f(V3d(std::cos(angle), std::sin(angle), 0)));
  expect_near(corner(b, 1.5), V3f(V3d(std::cos(half), std::sin(half), 0)));
}

TEST(Animation, NormalizedIntegersAreRotations) {
  GlbBuilder b = test::triangle_scene();
  const auto output = b.add_accessor(std::vector<std::array<std::int16_t, 4>>{{0, 0, 23170, 23170}},
                                     component_s16, "VEC4");
  b.json["accessors"][output]["normalized"] = true;
  animate(b, 0, "rotation", times(b, {0}), output, "LINEAR");
  expect_near(corner(b, 0), {0, 1, 0}, 1e-4F);
}

TEST(Animation, CubicSplines) {
  // glTF 2.0, appendix C.5: with u = (t - t_k) / t_d, here u = 1/4, t_d = 2.
  GlbBuilder b = test::triangle_scene();
  const auto output = b.add_accessor(
      std::vector<V3f>{{9, 9, 9}, {1, 0, 0}, {0, 2, 0}, {0, 0, 3}, {5, 0, 0}, {9, 9, 9}},
      component_float, "VEC3");
  animate(b, 0, "translation", times(b, {1, 3}), output, "CUBICSPLINE");
  const double u = 0.25;
  const double value0 = 2 * u * u * u - 3 * u * u + 1;
  const double tangent0 = 2 * (u * u * u - 2 * u * u + u);
  const double tangent1 = 2 * (u * u * u - u * u);
  expect_near(corner(b, 1.5), V3f(V3d(1 + value0 + 5 * (1 - value0), 2 * tangent0, 3 * tangent1)));
  expect_near(corner(b, 1), {2, 0, 0});
  expect_near(corner(b, 3), {6, 0, 0});
  expect_near(corner(b, 0), {2, 0, 0});
  expect_near(corner(b, 9), {6, 0, 0});
}

TEST(Animation, WeightsOfMorphTargets) {
  GlbBuilder b = test::triangle_scene();
  const auto along = [&](const V3f& v) {
    return b.add_accessor(std::vector<V3f>(3, v), component_float, "VEC3");
  };
  b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", along({1, 0, 0})}},
                                                     {{"POSITION", along({0, 0, 1})}}};
  b.json["meshes"][0]["weights"] = {7, 7};
  const auto output = b.add_accessor(std::vector<float>{0, 4, 2, 0}, component_float, "SCALAR");
  animate(b, 0, "weights", times(b, {0, 1}), output, "LINEAR");
  expect_near(corner(b, 0), {1, 0, 4});
  expect_near(corner(b, 0.5), {2, 0, 2});
  expect_near(corner(b, 1), {3, 0, 0});
}

TEST(Animation, MovesCamerasLightsAndJoints) {
  GlbBuilder b = test::triangle_scene();
  b.add_camera("eye", {0, 0, 5}, 0.8);
  b.add_light({{"type", "point"}});
  const auto output = b.add_accessor(std::vector<V3f>{{0, 0, 1}}, component_float, "VEC3");
  const auto input = times(b, {0});
  animate(b, 1, "translation", input, output, "");
  animate(b, 2, "translation", input, output, "");
  Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] =
      b.add_accessor(std::vector<std::array<std::uint8_t, 4>>(3), 5121, "VEC4");
  attributes["WEIGHTS_0"] =
      b.add_accessor(std::vector<std::array<float, 4>>{{1}, {1}, {1}}, component_float, "VEC4");
  b.json["skins"] = {{{"joints", {2}}}};
  b.json["nodes"][0]["skin"] = 0;
  const SceneData scene = load_at(b, {0.0});
  EXPECT_EQ(scene.cameras.at(0).to_world[3][2], 1.0);
  EXPECT_EQ(scene.lights.at(0).position, V3f(0, 0, 1));
  EXPECT_EQ(scene.meshes.at(0).positions[1], V3f(1, 0, 1));
}

TEST(Animation, OneOfThemByItsName) {
  GlbBuilder b = test::triangle_scene();
  const auto input = times(b, {0});
  const auto to = [&](float x) {
    return b.add_accessor(std::vector<V3f>{{x, 0, 0}}, component_float, "VEC3");
  };
  animate(b, 0, "translation", input, to(1), "", "walk");
  animate(b, 0, "translation", input, to(2), "", "run");
  const auto shown = [&](const std::string& name) { return load_at(b, {0.0, name}); };
  expect_near(shown("walk").meshes.at(0).positions[0], {1, 0, 0});
  expect_near(shown("run").meshes.at(0).positions[0], {2, 0, 0});
  EXPECT_TRUE(shown("run").warnings.empty());
  const SceneData both = shown("");
  expect_near(both.meshes.at(0).positions[0], {1, 0, 0});
  ASSERT_EQ(both.warnings.size(), 1U);
  EXPECT_NE(both.warnings[0].find("animations[1].channels[0].target: the translation of nodes[0] "
                                  "\"thing\" is animated already"),
            std::string::npos)
      << both.warnings[0];
  try {
    shown("fly");
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(
        std::string(e.what()).find("no animation is called \"fly\"; allowed: \"walk\", \"run\""),
        std::string::npos)
        << e.what();
  }
}

TEST(Animation, AHiddenNodeMayBeShown) {
  GlbBuilder b = test::triangle_scene();
  b.json["nodes"][0]["scale"] = {0, 0, 0};
  const auto output = b.add_accessor(std::vector<V3f>{{2, 2, 2}}, component_float, "VEC3");
  animate(b, 0, "scale", times(b, {0}), output, "");
  const SceneData scene = load_at(b, {0.0});
  EXPECT_EQ(scene.meshes.at(0).positions[1], V3f(2, 0, 0));
  EXPECT_TRUE(scene.warnings.empty()) << "of the static pose nothing is warned";
}

TEST(Animation, HashesDependOnTheTime) {
  GlbBuilder b = test::triangle_scene();
  const auto output =
      b.add_accessor(std::vector<V3f>{{0, 0, 0}, {1, 0, 0}}, component_float, "VEC3");
  animate(b, 0, "translation", times(b, {0, 1}), output, "", "walk");
  const SceneData still = load(b);
  const SceneData at0 = load_at(b, {0.0});
  const SceneData at1 = load_at(b, {1.0});
  EXPECT_EQ(still.geometry_hash, at0.geometry_hash) << "the same positions";
  EXPECT_NE(still.content_hash, at0.content_hash);
  EXPECT_NE(at0.content_hash, at1.content_hash);
  EXPECT_NE(at0.geometry_hash, at1.geometry_hash);
  EXPECT_NE(at1.content_hash, load_at(b, {1.0, "walk"}).content_hash);
  EXPECT_EQ(at1.content_hash, load_at(b, {1.0}).content_hash);
  ASSERT_EQ(still.warnings.size(), 1U);
  EXPECT_NE(still.warnings[0].find("animations are left out"), std::string::npos);
}

TEST(Animation, WithoutOneTimeIsWarnedOf) {
  const SceneData scene = load_at(test::triangle_scene(), {1.0});
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.warnings[0], "the file has no animations: time changes nothing");
}

TEST(Animation, ANameWithoutTimeIsWarnedOf) {
  const SceneData scene = load_at(test::triangle_scene(), {std::nullopt, "walk"});
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.warnings[0], "animation \"walk\" is left out, as no time is given");
}

TEST(Animation, FaultsAreRefusedWithTheirPlace) {
  GlbBuilder good = test::triangle_scene();
  const auto output =
      good.add_accessor(std::vector<V3f>{{0, 0, 0}, {1, 0, 0}}, component_float, "VEC3");
  animate(good, 0, "translation", times(good, {0, 1}), output, "");
  const auto expect = [&](const std::string& pointer, const Json& value, const std::string& words) {
    GlbBuilder b = good;
    b.json["animations"][0][Json::json_pointer(pointer)] = value;
    try {
      load_at(b, {0.5});
      ADD_FAILURE() << words;
    } catch (const SceneError& e) {
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
    EXPECT_EQ(load(b).triangle_count(), 1U) << "animations do not matter to the static pose";
  };
  expect("/channels/0/sampler", 1, "animations[0].channels[0]: sampler: found number 1");
  expect("/channels/0/target/node", 5, "animations[0].channels[0].target: node: found number 5");
  expect("/channels/0/target/path", "colour", "path: found string \"colour\"; allowed: \"transl");
  expect("/channels/0/target/path", "rotation", "used as output of animations[0].samplers[0]");
  expect("/samplers/0/input", 99, "animations[0].samplers[0]: input: found number 99");
  expect("/samplers/0/input", 0, "used as input of animations[0].samplers[0]");
  expect("/samplers/0/output", 0, "output has 3 elements for 2 keys of LINEAR");
  expect("/samplers/0/interpolation", "CUBICSPLINE", "output has 2 elements for 2 keys of CUBIC");
  expect("/samplers/0/interpolation", "BEZIER", "interpolation: found string \"BEZIER\"");

  GlbBuilder falling = good;
  falling.json["animations"][0]["samplers"][0]["input"] = times(falling, {1, 0});
  EXPECT_THROW(load_at(falling, {0.5}), SceneError);
  GlbBuilder matrix = good;
  matrix.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  EXPECT_THROW(load_at(matrix, {0.5}), SceneError);
  EXPECT_EQ(load(matrix).triangle_count(), 1U);
}

}  // namespace
}  // namespace lacuna
