#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::component_float;
using test::component_u16;
using test::component_u8;
using test::GlbBuilder;

using Joints = std::array<std::uint8_t, 4>;
using Weights = std::array<float, 4>;

/// Column-major, as glTF stores it.
std::array<float, 16> translation(float x, float y, float z) {
  return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, y, z, 1};
}

/// The triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) with normals +z on node 0, which two joints carry,
/// nodes 1 and 2.
GlbBuilder skinned(const std::vector<Joints>& joints, const std::vector<Weights>& weights) {
  GlbBuilder b;
  const V3f up(0, 0, 1);
  const auto mesh = b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, -1, {up, up, up});
  Json& attributes = b.json["meshes"][mesh]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = b.add_accessor(joints, component_u8, "VEC4");
  attributes["WEIGHTS_0"] = b.add_accessor(weights, component_float, "VEC4");
  b.json["skins"] = {{{"joints", {1, 2}}}};
  b.add_node({{"mesh", mesh}, {"skin", 0}, {"name", "body"}, {"translation", {100, 0, 0}}});
  b.add_node({{"translation", {5, 0, 0}}});
  b.add_node({{"translation", {0, 0, 3}}});
  return b;
}

GlbBuilder on_the_first_joint() { return skinned({{0}, {0}, {0}}, {{1}, {1}, {1}}); }

Mesh skinned_mesh(const GlbBuilder& b) { return load(b).meshes.at(0); }

TEST(Skin, JointsPlaceTheMeshAndItsNodeDoesNot) {
  const SceneData scene = load(on_the_first_joint());
  EXPECT_EQ(scene.meshes.at(0).positions, (std::vector<V3f>{{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}));
  EXPECT_EQ(scene.origin, V3d(0, 0, 0));
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Skin, WeightsBlendTheJoints) {
  const Mesh mesh =
      skinned_mesh(skinned({{0, 1}, {0, 1}, {1, 0}}, {{1, 0}, {0.25F, 0.75F}, {1, 0}}));
  expect_near(mesh.positions[0], {5, 0, 0});
  expect_near(mesh.positions[1], {2.25F, 0, 2.25F});
  expect_near(mesh.positions[2], {0, 1, 3});
}

TEST(Skin, InverseBindMatricesComeFirst) {
  GlbBuilder b = on_the_first_joint();
  const double h = std::numbers::sqrt2 / 2;  // a quarter turn about z
  b.json["nodes"][1]["rotation"] = {0, 0, h, h};
  b.json["skins"][0]["inverseBindMatrices"] = b.add_accessor(
      std::vector<std::array<float, 16>>{translation(-1, 0, 0), translation(0, 0, 0)},
      component_float, "MAT4");
  const Mesh mesh = skinned_mesh(b);
  expect_near(mesh.positions[0], {5, -1, 0});  // (-1, 0, 0) turned is (0, -1, 0)
  expect_near(mesh.positions[1], {5, 0, 0});
  expect_near(mesh.positions[2], {4, -1, 0});
}

TEST(Skin, JointsHaveParentsAndNeedNoScene) {
  GlbBuilder b = on_the_first_joint();
  b.json["nodes"].push_back({{"scale", {2, 2, 2}}, {"children", {1}}});
  b.json["scenes"][0]["nodes"] = {0};
  expect_near(skinned_mesh(b).positions[1], {12, 0, 0});
}

TEST(Skin, NormalsTurnWithTheirJoint) {
  GlbBuilder b = on_the_first_joint();
  const double h = std::numbers::sqrt2 / 2;  // a quarter turn about x: z becomes -y
  b.json["nodes"][1]["rotation"] = {h, 0, 0, h};
  expect_near(skinned_mesh(b).normals[0], {0, -1, 0});
}

TEST(Skin, MirroredJointsKeepTheFront) {
  GlbBuilder b = on_the_first_joint();
  b.json["nodes"][1]["scale"] = {-1, 1, 1};
  const Mesh mesh = skinned_mesh(b);
  expect_near(mesh.normals[0], {0, 0, 1});
  const auto& t = mesh.triangles.at(0);
  const V3f& a = mesh.positions[t[0]];
  EXPECT_GT((mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).z, 0);
}

TEST(Skin, AScaleOfItsOwnNodeDoesNotHideIt) {
  GlbBuilder b = on_the_first_joint();
  b.json["nodes"][0]["scale"] = {0, 0, 0};
  const SceneData scene = load(b);
  EXPECT_EQ(scene.triangle_count(), 1U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Skin, NormalizedWeightsAndASecondSet) {
  GlbBuilder b = on_the_first_joint();
  Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  const std::array<std::uint16_t, 4> half{32768};
  const std::vector<std::array<std::uint16_t, 4>> halves{half, half, half};
  for (const char* name : {"WEIGHTS_0", "WEIGHTS_1"}) {
    attributes[name] = b.add_accessor(halves, component_u16, "VEC4");
    b.json["accessors"].back()["normalized"] = true;
  }
  attributes["JOINTS_1"] = b.add_accessor(std::vector<std::array<std::uint16_t, 4>>{{1}, {1}, {1}},
                                          component_u16, "VEC4");
  expect_near(skinned_mesh(b).positions[0], {2.5F, 0, 1.5F});
}

// 1,000 sets of joints for each of 40,000 vertices, in a file of a megabyte.
TEST(Skin, ManySetsOfJointsAreRefused) {
  constexpr std::size_t vertices = 40000;
  GlbBuilder b = on_the_first_joint();
  Json& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
  const auto joints = b.add_accessor(std::vector<Joints>(vertices), component_u8, "VEC4");
  const auto weights = b.add_accessor(std::vector<Weights>(vertices, {1}), component_float, "VEC4");
  attributes = {{"POSITION", b.add_accessor(std::vector<V3f>(vertices, V3f(1, 2, 3)),
                                            component_float, "VEC3")}};
  for (int set = 0; set < 1000; ++set) {
    attributes["JOINTS_" + std::to_string(set)] = joints;
    attributes["WEIGHTS_" + std::to_string(set)] = weights;
  }
  try {
    load(b);
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("morph targets and joints move vertices more than"),
              std::string::npos)
        << e.what();
  }
}

TEST(Skin, VerticesWithoutWeightsGoWithTheFirstJoint) {
  GlbBuilder b = skinned({{1}, {1}, {1}}, {{1}, {0}, {1}});
  const SceneData scene = load(b);
  expect_near(scene.meshes.at(0).positions[1], {6, 0, 0});
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("1 vertices have no weights"), std::string::npos);
}

TEST(Skin, MorphTargetsComeBeforeJoints) {
  GlbBuilder b = on_the_first_joint();
  b.json["meshes"][0]["primitives"][0]["targets"] = {
      {{"POSITION", b.add_accessor(std::vector<V3f>(3, V3f(0, 0, 1)), component_float, "VEC3")}}};
  b.json["meshes"][0]["weights"] = {2};
  b.json["nodes"][1]["scale"] = {1, 1, 10};
  expect_near(skinned_mesh(b).positions[0], {5, 0, 20});
}

TEST(Skin, HostileOnesAreRefusedWithTheirPlace) {
  const auto expect = [](const GlbBuilder& b, const std::string& words) {
    try {
      load(b);
      ADD_FAILURE() << words;
    } catch (const SceneError& e) {
      EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    }
  };
  expect(skinned({{0}, {2}, {0}}, {{1}, {1}, {1}}),
         "meshes[0].primitives[0] under nodes[0] \"body\": JOINTS_0 of vertex 1 has 2; allowed: "
         "below 2, the joints of its skin");
  EXPECT_EQ(load(skinned({{0}, {2}, {0}}, {{1}, {0}, {1}})).triangle_count(), 1U)
      << "a joint without weight does not matter";
  const auto with = [](const std::string& pointer, const Json& value) {
    GlbBuilder b = on_the_first_joint();
    b.json[Json::json_pointer(pointer)] = value;
    return b;
  };
  expect(with("/nodes/0/skin", 1), "nodes[0] \"body\": skin: found number 1");
  expect(with("/skins/0/joints", {1, 7}), "skins[0]: joints[1]: found number 7");
  expect(with("/skins/0/joints", Json::array()), "skins[0]: joints is missing or empty");
  expect(with("/skins/0/inverseBindMatrices", 99), "skins[0]: inverseBindMatrices: found number");
  expect(with("/skins/0/inverseBindMatrices", 0), "used as inverseBindMatrices of skins[0]");
  expect(
      with("/nodes/1/scale", {1e300, 1e300, 1e300}),
      "skins[0]: the transform of joints[0], nodes[1], with its inverse bind matrix, is too large");
  GlbBuilder few = on_the_first_joint();
  few.json["skins"][0]["inverseBindMatrices"] = few.add_accessor(
      std::vector<std::array<float, 16>>{translation(0, 0, 0)}, component_float, "MAT4");
  expect(few, "skins[0]: inverseBindMatrices has 1 matrices for 2 joints");
  constexpr float infinite = std::numeric_limits<float>::infinity();
  EXPECT_THROW(load(skinned({{0}, {0}, {0}}, {{1}, {infinite}, {1}})), SceneError)
      << "the only triangle has a vertex that is not finite";
}

}  // namespace
}  // namespace lacuna
