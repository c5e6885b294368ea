#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::component_float;
using test::GlbBuilder;

/// The triangle (0, 0, 0), (1, 0, 0), (0, 1, 0) with normals +z and two targets: along x, and along
/// z with the normals bent to +y.
GlbBuilder morphed() {
  GlbBuilder b;
  const V3f up(0, 0, 1);
  const auto mesh = b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, -1, {up, up, up});
  const auto along_x =
      b.add_accessor(std::vector<V3f>{{5, 0, 0}, {5, 0, 0}, {7, 0, 0}}, component_float, "VEC3");
  const auto along_z =
      b.add_accessor(std::vector<V3f>{{0, 0, 2}, {0, 0, 2}, {0, 0, 2}}, component_float, "VEC3");
  const auto bent =
      b.add_accessor(std::vector<V3f>{{0, 1, -1}, {0, 1, -1}, {0, 0, 0}}, component_float, "VEC3");
  b.json["meshes"][mesh]["primitives"][0]["targets"] = {{{"POSITION", along_x}},
                                                        {{"POSITION", along_z}, {"NORMAL", bent}}};
  b.add_node({{"mesh", mesh}, {"name", "thing"}});
  return b;
}

Mesh morphed_mesh(const GlbBuilder& b) { return load(b).meshes.at(0); }

TEST(Morph, WithoutWeightsItIsTheBase) {
  EXPECT_EQ(morphed_mesh(morphed()).positions, (std::vector<V3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_TRUE(load(morphed()).warnings.empty());
}

TEST(Morph, WeightsOfTheMeshAddDisplacements) {
  GlbBuilder b = morphed();
  b.json["meshes"][0]["weights"] = {1, -0.5};
  const Mesh mesh = morphed_mesh(b);
  EXPECT_EQ(mesh.positions, (std::vector<V3f>{{5, 0, -1}, {6, 0, -1}, {7, 1, -1}}));
}

TEST(Morph, WeightsOfTheNodeComeBeforeThoseOfTheMesh) {
  GlbBuilder b = morphed();
  b.json["meshes"][0]["weights"] = {1, 0};
  b.json["nodes"][0]["weights"] = {0, 2};
  b.add_node({{"mesh", 0}, {"translation", {0, 0, 1}}});
  const SceneData scene = load(b);
  expect_near(scene.meshes.at(0).positions[1], {1, 0, 4});
  expect_near(scene.meshes.at(1).positions[1], {6, 0, 1});
}

TEST(Morph, NormalsAreMorphedToUnitLength) {
  GlbBuilder b = morphed();
  b.json["nodes"][0]["weights"] = {0, 0.25};
  b.json["nodes"][0]["scale"] = {1, 2, 1};
  const Mesh mesh = morphed_mesh(b);
  // (0, 0, 1) + .25 (0, 1, -1), then by the inverse transpose of the scale.
  expect_near(mesh.normals[0], V3f(0, 0.125F, 0.75F).normalized());
  expect_near(mesh.normals[2], {0, 0, 1});
}

TEST(Morph, SparseAndQuantizedTargets) {
  GlbBuilder b = morphed();
  const auto indices = b.add_view(std::vector<std::uint8_t>{2});
  const auto values = b.add_view(std::vector<V3f>{{0, 3, 0}});
  b.json["accessors"].push_back({{"componentType", component_float},
                                 {"count", 3},
                                 {"type", "VEC3"},
                                 {"sparse",
                                  {{"count", 1},
                                   {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                   {"values", {{"bufferView", values}}}}}});
  const std::size_t sparse = b.json["accessors"].size() - 1;
  const auto shorts = b.add_view(std::vector<std::int16_t>{0, 0, -32767, 0, 0, 0, 32767, 0});
  b.json["bufferViews"][shorts]["byteStride"] = 8;
  b.json["bufferViews"][shorts]["byteLength"] = 16;
  b.json["accessors"].push_back({{"bufferView", shorts},
                                 {"componentType", 5122},
                                 {"count", 2},
                                 {"normalized", true},
                                 {"type", "VEC3"}});
  const std::size_t quantized = b.json["accessors"].size() - 1;
  b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", sparse}},
                                                     {{"POSITION", quantized}}};
  b.json["meshes"][0]["weights"] = {1, 0};
  EXPECT_EQ(morphed_mesh(b).positions, (std::vector<V3f>{{0, 0, 0}, {1, 0, 0}, {0, 4, 0}}));
  b.json["meshes"][0]["weights"] = {0, 1};
  EXPECT_THROW(load(b), SceneError) << "two displacements for three vertices";
  b.json["accessors"][quantized]["count"] = 1;
  b.json["accessors"][quantized]["sparse"] = b.json["accessors"][sparse]["sparse"];
  EXPECT_THROW(load(b), SceneError) << "sparse.indices[0] is 2";
  const auto three =
      b.add_view(std::vector<std::int16_t>{0, 0, -32767, 0, 32767, 0, 0, 0, 0, 16384, 0, 0});
  b.json["bufferViews"][three]["byteStride"] = 8;
  b.json["accessors"][quantized] = {{"bufferView", three},
                                    {"componentType", 5122},
                                    {"count", 3},
                                    {"normalized", true},
                                    {"type", "VEC3"}};
  const auto positions = morphed_mesh(b).positions;
  expect_near(positions[0], {0, 0, -1});
  expect_near(positions[1], {2, 0, 0});
  expect_near(positions[2], {0, 1 + 16384.0F / 32767, 0});
}

TEST(Morph, AnotherNumberOfWeightsIsWarnedOf) {
  GlbBuilder b = morphed();
  b.json["nodes"][0]["weights"] = {1};
  const SceneData scene = load(b);
  expect_near(scene.meshes.at(0).positions[0], {5, 0, 0});
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("1 weights for 2 morph targets"), std::string::npos)
      << scene.warnings[0];
}

TEST(Morph, BoundsOfAMorphedMeshMoveTheOrigin) {
  GlbBuilder b = morphed();
  b.json["nodes"][0]["weights"] = {0, 1e6};
  const SceneData scene = load(b);
  EXPECT_NEAR(scene.origin.z, 2e6, 1);
}

TEST(Morph, HostileWeightsAreRefused) {
  const auto error = [](const Json& weights) -> std::string {
    GlbBuilder b = morphed();
    b.json["nodes"][0]["weights"] = weights;
    try {
      load(b);
    } catch (const SceneError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(error({1, "x"}).find("nodes[0] \"thing\": weights[1]: found string"),
            std::string::npos);
  EXPECT_NE(error({1e30, 0}).find("vertex 0 lies at"), std::string::npos);
  EXPECT_NE(error({1e60, 0}).find("weights[0]: found number 1e+60"), std::string::npos);
  // 2^15 targets of 40,000 vertices each, in a file of a megabyte.
  GlbBuilder b = morphed();
  const std::vector<V3f> points(40000, V3f(1, 2, 3));
  const auto accessor = b.add_accessor(points, component_float, "VEC3");
  Json& crowded = b.json["meshes"][0]["primitives"][0];
  crowded["attributes"] = {{"POSITION", accessor}};
  crowded["targets"] = std::vector<Json>(1 << 15, Json{{"POSITION", accessor}});
  b.json["nodes"][0]["weights"] = std::vector<int>(1 << 15, 1);
  try {
    load(b);
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("morph targets and joints move vertices more than"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace lacuna
