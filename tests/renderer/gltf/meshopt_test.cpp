#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include <cmath>

#include "base/json/json_text.h"
#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::GlbBuilder;

/// What a bufferView holds, and its compressed form.
struct Packed {
  test::Bytes bytes;
  std::size_t count = 0, stride = 0;
  std::string mode, filter = "NONE";
};

template <class T>
Packed attributes(const std::vector<T>& values) {
  Packed p{{}, values.size(), sizeof(T), "ATTRIBUTES"};
  p.bytes.resize(meshopt_encodeVertexBufferBound(values.size(), sizeof(T)));
  p.bytes.resize(meshopt_encodeVertexBuffer(p.bytes.data(), p.bytes.size(), values.data(),
                                            values.size(), sizeof(T)));
  return p;
}

Packed triangles(const std::vector<std::uint32_t>& indices, std::size_t stride) {
  Packed p{{}, indices.size(), stride, "TRIANGLES"};
  p.bytes.resize(meshopt_encodeIndexBufferBound(indices.size(), 16));
  p.bytes.resize(
      meshopt_encodeIndexBuffer(p.bytes.data(), p.bytes.size(), indices.data(), indices.size()));
  return p;
}

Packed sequence(const std::vector<std::uint32_t>& indices) {
  Packed p{{}, indices.size(), 4, "INDICES"};
  p.bytes.resize(meshopt_encodeIndexSequenceBound(indices.size(), 16));
  p.bytes.resize(
      meshopt_encodeIndexSequence(p.bytes.data(), p.bytes.size(), indices.data(), indices.size()));
  return p;
}

/// Adds a bufferView of the fallback buffer, buffers[1], that the extension fills.
std::size_t add_packed(GlbBuilder& b, const Packed& p) {
  const auto raw = b.add_view(p.bytes);
  Json view = b.json["bufferViews"][raw];
  b.json["bufferViews"].erase(raw);
  const std::size_t bytes = p.count * p.stride;
  const std::size_t offset = b.json.value("/buffers/1/byteLength"_json_pointer, std::size_t{0});
  Json extension{{"buffer", 0},
                 {"byteOffset", view["byteOffset"]},
                 {"byteLength", p.bytes.size()},
                 {"byteStride", p.stride},
                 {"count", p.count},
                 {"mode", p.mode},
                 {"filter", p.filter}};
  Json decoded{{"buffer", 1}, {"byteOffset", offset}, {"byteLength", bytes}};
  if (p.mode == "ATTRIBUTES") decoded["byteStride"] = p.stride;
  decoded["extensions"]["EXT_meshopt_compression"] = extension;
  b.json["bufferViews"].push_back(decoded);
  b.json["buffers"][0] = {{"byteLength", b.bin.size()}};
  b.json["buffers"][1] = {{"byteLength", (offset + bytes + 3) / 4 * 4},
                          {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
  return b.json["bufferViews"].size() - 1;
}

std::size_t add_packed_accessor(GlbBuilder& b, const Packed& p, int component,
                                const std::string& type, bool normalized = false) {
  b.json["accessors"].push_back({{"bufferView", add_packed(b, p)},
                                 {"componentType", component},
                                 {"count", p.count},
                                 {"type", type},
                                 {"normalized", normalized}});
  return b.json["accessors"].size() - 1;
}

const std::vector<V3f> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5F}};

/// Two triangles of compressed positions and indices; more attributes may follow.
GlbBuilder packed_scene(const Packed& indices, const Packed& positions = attributes(corners)) {
  GlbBuilder b;
  b.json["extensionsUsed"] =
      b.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  const auto position = add_packed_accessor(b, positions, test::component_float, "VEC3");
  const auto index = add_packed_accessor(
      b, indices, indices.stride == 2 ? test::component_u16 : test::component_u32, "SCALAR");
  b.json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", position}}}, {"indices", index}}}}}};
  b.add_node({{"mesh", 0}});
  return b;
}

const std::vector<std::uint32_t> two_triangles{0, 1, 2, 2, 1, 3};

TEST(Meshopt, TrianglesAndSequencesOfIndices) {
  for (const Packed& indices :
       {triangles(two_triangles, 4), triangles(two_triangles, 2), sequence(two_triangles)}) {
    const SceneData scene = load(packed_scene(indices));
    EXPECT_EQ(scene.meshes.at(0).positions, corners) << indices.mode;
    EXPECT_EQ(scene.meshes.at(0).triangles, (test::Triangles{{0, 1, 2}, {2, 1, 3}}));
    EXPECT_TRUE(scene.warnings.empty());
  }
}

TEST(Meshopt, FilesWithExternalBuffers) {
  const GlbBuilder b = packed_scene(triangles(two_triangles, 4));
  const TemporaryFolder folder;
  folder.write("data.bin", b.bin);
  Json json = b.json;
  json["buffers"][0]["uri"] = "data.bin";
  json["buffers"][1]["uri"] = "missing.bin";
  EXPECT_EQ(load_gltf(folder.write("scene.gltf", json_text(json))).meshes.at(0).positions, corners)
      << "a fallback is not read";
}

TEST(Meshopt, OctahedralNormals) {
  const std::vector<V3f> normals{{0, 0, 1}, {1, 0, 0}, {0.6F, 0, -0.8F}, {-0.6F, 0.64F, 0.48F}};
  std::vector<std::array<float, 4>> wide;
  for (const V3f& n : normals) wide.push_back({n.x, n.y, n.z, 0});
  GlbBuilder b = packed_scene(triangles(two_triangles, 4));
  std::vector<std::array<std::int16_t, 4>> shorts(normals.size());
  meshopt_encodeFilterOct(shorts.data(), shorts.size(), 8, 16, wide[0].data());
  Packed packed = attributes(shorts);
  packed.filter = "OCTAHEDRAL";
  b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
      add_packed_accessor(b, packed, test::component_s16, "VEC3", true);
  const Mesh mesh = load(b).meshes.at(0);
  for (std::size_t i = 0; i < normals.size(); ++i) expect_near(mesh.normals[i], normals[i], 1e-4F);
}

TEST(Meshopt, ExponentialPositions) {
  const std::vector<V3f> values{{0, 0, 0}, {1.5F, 0, 0}, {0, 0.0625F, 0}, {-3, 5, 1024}};
  std::vector<V3f> encoded(values.size());
  meshopt_encodeFilterExp(encoded.data(), values.size(), 12, 15, &values[0].x);
  Packed packed = attributes(encoded);
  packed.filter = "EXPONENTIAL";
  const Mesh mesh = load(packed_scene(triangles(two_triangles, 4), packed)).meshes.at(0);
  expect_near(mesh.positions[1], {1.5F, 0, 0});
  expect_near(mesh.positions[2], {0, 0.0625F, 0});
  expect_near(mesh.positions[3], {-3, 5, 1024}, 0.1F);
}

TEST(Meshopt, QuaternionsOfAnAnimation) {
  GlbBuilder b = packed_scene(triangles(two_triangles, 4));
  const float h = std::sqrt(0.5F);  // a quarter turn about z
  const std::vector<std::array<float, 4>> rotation{{0, 0, h, h}};
  std::vector<std::array<std::int16_t, 4>> shorts(1);
  meshopt_encodeFilterQuat(shorts.data(), 1, 8, 16, rotation[0].data());
  Packed packed = attributes(shorts);
  packed.filter = "QUATERNION";
  const auto output = add_packed_accessor(b, packed, test::component_s16, "VEC4", true);
  const auto input =
      add_packed_accessor(b, attributes(std::vector<float>{0}), test::component_float, "SCALAR");
  b.json["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}}}},
       {"samplers", {{{"input", input}, {"output", output}}}}}};
  const TemporaryFolder folder;
  const SceneData scene = load_gltf(folder.write("scene.glb", b.glb()), nullptr, {0.0});
  expect_near(scene.meshes.at(0).positions[1], {0, 1, 0}, 1e-4F);
}

/// The error of the scene with a value at a JSON pointer.
std::string packed_error(const std::string& pointer, const Json& value) {
  GlbBuilder b = packed_scene(triangles(two_triangles, 4));
  b.json[Json::json_pointer(pointer)] = value;
  try {
    load(b);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "loaded";
}

TEST(Meshopt, HostileOnesAreRefusedWithTheirPlace) {
  const std::string vertices = "/bufferViews/0/extensions/EXT_meshopt_compression";
  const std::string indices = "/bufferViews/1/extensions/EXT_meshopt_compression";
  const auto expect = [](const std::string& error, const std::string& words) {
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  const std::string place = "bufferViews[0].extensions.EXT_meshopt_compression: ";
  expect(packed_error(vertices + "/count", 4000000), place + "claims 48000000 bytes of ");
  expect(packed_error(vertices + "/count", 5), place + "count times byteStride is 60");
  expect(packed_error(vertices + "/count", 0), place + "count: found number 0");
  expect(packed_error(vertices + "/byteStride", 6), "byteStride: found number 6");
  expect(packed_error(vertices + "/byteStride", 260), "byteStride: found number 260");
  expect(packed_error(vertices + "/byteLength", 9000), "are outside of buffers[0]");
  expect(packed_error(vertices + "/byteOffset", 2000000000), "are outside of buffers[0]");
  expect(packed_error(vertices + "/byteLength", 20), "elements of mode ATTRIBUTES");
  expect(packed_error(vertices + "/buffer", 1), "allowed: one that has data of its own");
  expect(packed_error(vertices + "/buffer", 2), "buffer: found number 2");
  expect(packed_error(vertices + "/mode", "POINTS"), "mode: found string \"POINTS\"");
  expect(packed_error(vertices + "/mode", "TRIANGLES"), "byteStride: found number 12");
  expect(packed_error(vertices + "/filter", "QUATERNION"), "byteStride: found number 12");
  expect(packed_error(vertices + "/filter", "OCTAHEDRAL"), "byteStride: found number 12");
  expect(packed_error(vertices + "/filter", "SHARPEN"), "filter: found string \"SHARPEN\"");
  expect(packed_error(indices + "/filter", "EXPONENTIAL"), "filter: found string");
  expect(packed_error(indices + "/byteStride", 8), "byteStride: found number 8");
  expect(packed_error("/bufferViews/0/extensions", Json::object()),
         "bufferViews[0]: its buffer, buffers[1], has no data but those that EXT_meshopt");
  expect(packed_error("/buffers/1/byteLength", 2000000000),
         "buffers[1]: byteLength is 2000000000, of which bufferViews fill 72");
}

TEST(Meshopt, EveryBrokenByteIsHarmless) {
  const GlbBuilder good = packed_scene(triangles(two_triangles, 4));
  const std::size_t used = good.bin.size();
  for (std::size_t i = 0; i < used; ++i) {
    GlbBuilder b = good;
    b.bin[i] = static_cast<std::uint8_t>(~b.bin[i]);
    try {
      load(b);
    } catch (const SceneError&) {
    }
  }
}

}  // namespace
}  // namespace lacuna
