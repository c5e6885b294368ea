#include <gtest/gtest.h>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::GlbBuilder;

/// Adds four integers for each vertex, of which the attribute has `per_vertex`: attributes have a
/// byteStride that is a multiple of 4.
template <class T>
std::size_t add_quantized(GlbBuilder& b, const std::vector<std::array<T, 4>>& values, int component,
                          int per_vertex, bool normalized) {
  const auto view = b.add_view(values);
  b.json["bufferViews"][view]["byteStride"] = sizeof(std::array<T, 4>);
  b.json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component},
                                 {"count", values.size()},
                                 {"normalized", normalized},
                                 {"type", "VEC" + std::to_string(per_vertex)}});
  return b.json["accessors"].size() - 1;
}

/// The triangle scene with one attribute of integers.
template <class T>
Mesh mesh_with(const std::string& attribute, const std::vector<std::array<T, 4>>& values,
               int component, int per_vertex, bool normalized, const Json& node = Json::object()) {
  GlbBuilder b = test::triangle_scene();
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const auto texture = b.add_texture(test::encode8(1, 1, 3, {255, 0, 0}));
  b.add_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  Json& quantized = b.json["meshes"][0]["primitives"][0];
  quantized["material"] = 0;
  if (attribute == "TEXCOORD_0") quantized["attributes"]["TEXCOORD_0"] = 0;
  quantized["attributes"][attribute] = add_quantized(b, values, component, per_vertex, normalized);
  b.json["nodes"][0].update(node);
  return load(b).meshes.at(0);
}

TEST(Quantization, PlainIntegersArePositionsAsTheyAre) {
  const std::vector<V3f> wanted{{-128, 0, 5}, {127, 0, 5}, {0, 100, 5}};
  using Bytes4 = std::vector<std::array<std::int8_t, 4>>;
  using Shorts4 = std::vector<std::array<std::int16_t, 4>>;
  EXPECT_EQ(mesh_with("POSITION", Bytes4{{-128, 0, 5}, {127, 0, 5}, {0, 100, 5}},
                      test::component_s8, 3, false)
                .positions,
            wanted);
  EXPECT_EQ(mesh_with("POSITION", Shorts4{{-128, 0, 5}, {127, 0, 5}, {0, 100, 5}},
                      test::component_s16, 3, false)
                .positions,
            wanted);
  const std::vector<V3f> large{{0, 0, 9}, {65535, 0, 9}, {0, 40000, 9}};
  EXPECT_EQ(
      mesh_with("POSITION",
                std::vector<std::array<std::uint16_t, 4>>{{0, 0, 9}, {65535, 0, 9}, {0, 40000, 9}},
                test::component_u16, 3, false)
          .positions,
      large);
}

TEST(Quantization, NormalizedOnesAreFractionsOfTheLargest) {
  // glTF 2.0, section 3.6.2.2: max(c / 127, -1) and so on.
  const Mesh bytes = mesh_with(
      "POSITION", std::vector<std::array<std::int8_t, 4>>{{-128, -127, 0}, {127, 0, 0}, {0, 64, 0}},
      test::component_s8, 3, true);
  expect_near(bytes.positions[0], {-1, -1, 0});
  expect_near(bytes.positions[1], {1, 0, 0});
  expect_near(bytes.positions[2], {0, 64.0F / 127, 0});
  const Mesh shorts = mesh_with(
      "POSITION",
      std::vector<std::array<std::int16_t, 4>>{{-32768, -32767, 0}, {32767, 0, 0}, {0, 16384, 0}},
      test::component_s16, 3, true);
  expect_near(shorts.positions[0], {-1, -1, 0});
  expect_near(shorts.positions[1], {1, 0, 0});
  expect_near(shorts.positions[2], {0, 16384.0F / 32767, 0});
  const Mesh unsigned_bytes = mesh_with(
      "POSITION", std::vector<std::array<std::uint8_t, 4>>{{0, 0, 51}, {255, 0, 51}, {0, 102, 51}},
      test::component_u8, 3, true);
  expect_near(unsigned_bytes.positions[2], {0, 0.4F, 0.2F});
}

TEST(Quantization, TheNodePlacesThem) {
  const double step = 1.0 / 16;
  const Mesh mesh = mesh_with(
      "POSITION", std::vector<std::array<std::int16_t, 4>>{{0, 0}, {16, 0}, {0, -32}},
      test::component_s16, 3, false, {{"scale", {step, step, step}}, {"translation", {1, 2, 3}}});
  expect_near(mesh.positions[0], {1, 2, 3});
  expect_near(mesh.positions[1], {2, 2, 3});
  expect_near(mesh.positions[2], {1, 0, 3});
}

TEST(Quantization, NormalsAreOfUnitLength) {
  const Mesh bytes = mesh_with(
      "NORMAL", std::vector<std::array<std::int8_t, 4>>{{127, 0, 0}, {0, -128, 0}, {76, 0, 102}},
      test::component_s8, 3, true);
  expect_near(bytes.normals[0], {1, 0, 0});
  expect_near(bytes.normals[1], {0, -1, 0});
  expect_near(bytes.normals[2], V3f(76, 0, 102).normalized());
  const Mesh shorts = mesh_with(
      "NORMAL", std::vector<std::array<std::int16_t, 4>>{{0, 0, 32767}, {0, 1, 0}, {-3, 0, 4}},
      test::component_s16, 3, true);
  expect_near(shorts.normals[1], {0, 1, 0});
  expect_near(shorts.normals[2], {-0.6F, 0, 0.8F});
}

TEST(Quantization, TextureCoordinates) {
  const auto uvs = [](const Mesh& mesh) { return mesh.uvs[0]; };
  const std::vector<V2f> plain{{0, 2}, {300, 0}, {-7, 1}};
  EXPECT_EQ(uvs(mesh_with("TEXCOORD_0",
                          std::vector<std::array<std::int16_t, 4>>{{0, 2}, {300, 0}, {-7, 1}},
                          test::component_s16, 2, false)),
            plain);
  EXPECT_EQ(uvs(mesh_with("TEXCOORD_0",
                          std::vector<std::array<std::uint8_t, 4>>{{0, 2}, {200, 0}, {7, 1}},
                          test::component_u8, 2, false))[1],
            V2f(200, 0));
  EXPECT_EQ(uvs(mesh_with("TEXCOORD_0",
                          std::vector<std::array<std::int8_t, 4>>{{127, -127}, {0, 0}, {0, 0}},
                          test::component_s8, 2, true))[0],
            V2f(1, -1));
}

TEST(Quantization, PlainIntegersAreNoNormals) {
  try {
    mesh_with("NORMAL", std::vector<std::array<std::int8_t, 4>>{{127}, {127}, {127}},
              test::component_s8, 3, false);
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("used as NORMAL of meshes[0].primitives[0]"),
              std::string::npos)
        << e.what();
  }
}

}  // namespace
}  // namespace lacuna
