#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::GlbBuilder;
using test::Json;

/// Two triangles of a square with a raised corner, and normals.
struct DracoSource {
  test::Bytes bytes;
  std::size_t vertices = 0;
  std::uint32_t position_id = 0, normal_id = 0;
};

DracoSource encode_draco(bool edgebreaker, int normal_bits) {
  const std::vector<V3f> corners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0.5F}};
  const V3f normal = V3f(-0.6F, 0, 0.8F);
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(2);
  const int position =
      builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normals = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const test::Triangles faces{{0, 1, 2}, {2, 1, 3}};
  for (std::uint32_t f = 0; f < 2; ++f) {
    const auto& [a, b, c] = faces[f];
    builder.SetAttributeValuesForFace(position, draco::FaceIndex(f), &corners[a].x, &corners[b].x,
                                      &corners[c].x);
    builder.SetAttributeValuesForFace(normals, draco::FaceIndex(f), &normal.x, &normal.x,
                                      &normal.x);
  }
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                        : draco::MESH_SEQUENTIAL_ENCODING);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
  if (normal_bits > 0) {
    encoder.SetAttributeQuantization(draco::GeometryAttribute::NORMAL, normal_bits);
  }
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {{buffer.data(), buffer.data() + buffer.size()},
          mesh->num_points(),
          mesh->attribute(position)->unique_id(),
          mesh->attribute(normals)->unique_id()};
}

GlbBuilder draco_scene(bool edgebreaker = true, int normal_bits = 12) {
  const DracoSource source = encode_draco(edgebreaker, normal_bits);
  GlbBuilder b;
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const auto view = b.add_view(source.bytes);
  b.json["accessors"] = {
      {{"componentType", test::component_float}, {"count", source.vertices}, {"type", "VEC3"}},
      {{"componentType", test::component_float}, {"count", source.vertices}, {"type", "VEC3"}},
      {{"componentType", test::component_u16}, {"count", 6}, {"type", "SCALAR"}}};
  b.json["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}},
          {"indices", 2},
          {"extensions",
           {{"KHR_draco_mesh_compression",
             {{"bufferView", view},
              {"attributes",
               {{"POSITION", source.position_id}, {"NORMAL", source.normal_id}}}}}}}}}}}};
  b.add_node({{"mesh", 0}, {"name", "thing"}});
  return b;
}

TEST(Draco, BothWaysOfConnectivity) {
  for (const bool edgebreaker : {false, true}) {
    const SceneData scene = load(draco_scene(edgebreaker));
    const Mesh& mesh = scene.meshes.at(0);
    EXPECT_TRUE(scene.warnings.empty());
    ASSERT_EQ(mesh.triangles.size(), 2U) << edgebreaker;
    double area = 0;
    double height = 0;
    for (const auto& t : mesh.triangles) {
      const V3f& a = mesh.positions[t[0]];
      area += (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).length() / 2;
      for (const std::uint32_t v : t) height = std::max(height, double(mesh.positions[v].z));
    }
    // Half a square, and the triangle (0, 1, 0), (1, 0, 0), (1, 1, .5).
    EXPECT_NEAR(area, 0.5 + std::sqrt(1.5) / 2, 1e-3) << edgebreaker;
    EXPECT_NEAR(height, 0.5, 1e-4);
    for (const V3f& n : mesh.normals) expect_near(n, {-0.6F, 0, 0.8F}, 2e-3F);
  }
}

TEST(Draco, IndicesOfOtherSizes) {
  for (const int component : {test::component_u8, test::component_u32}) {
    GlbBuilder b = draco_scene();
    b.json["accessors"][2]["componentType"] = component;
    EXPECT_EQ(load(b).triangle_count(), 2U);
  }
}

TEST(Draco, AnAttributeThatItDoesNotHoldIsReadAsUsual) {
  GlbBuilder b = draco_scene();
  const auto normals = b.add_accessor(
      std::vector<V3f>(b.json["accessors"][0]["count"].get<std::size_t>(), V3f(0, 1, 0)),
      test::component_float, "VEC3");
  Json& primitive_json = b.json["meshes"][0]["primitives"][0];
  primitive_json["attributes"]["NORMAL"] = normals;
  primitive_json["extensions"]["KHR_draco_mesh_compression"]["attributes"].erase("NORMAL");
  expect_near(load(b).meshes.at(0).normals.at(0), {0, 1, 0});
}

std::string draco_error(const GlbBuilder& b) {
  try {
    load(b);
  } catch (const SceneError& e) {
    return e.what();
  }
  return "loaded";
}

TEST(Draco, HostileOnesAreRefusedWithTheirPlace) {
  const std::string p = "/meshes/0/primitives/0";
  const std::string extension = p + "/extensions/KHR_draco_mesh_compression";
  const std::string place = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
  const auto expect = [](const std::string& pointer, const Json& value, const std::string& words) {
    GlbBuilder b = draco_scene();
    b.json[Json::json_pointer(pointer)] = value;
    const std::string error = draco_error(b);
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  expect(extension + "/bufferView", 1, place + ": bufferView: found number 1");
  expect(extension + "/attributes/POSITION", 77, place + ".attributes: POSITION: found number 77");
  expect(extension + "/attributes", Json::object(), place + ": attributes is empty");
  expect(extension + "/attributes/TEXCOORD_0", 0, "TEXCOORD_0: found number 0; allowed: only attr");
  expect(p + "/mode", 5, "mode: found number 5; allowed: 4 (triangles), as its data are of Draco");
  expect("/accessors/2/count", 9, place + ": its Draco data have 6 indices; its accessors have 9");
  expect("/accessors/0/count", 3, "vertices; its accessors have 3");
  expect("/accessors/0/count", 5, place + ": its Draco data have 4 vertices; its accessors have 5");
  expect("/accessors/0/count", 134217728, "all Draco data down to here have more than");
  expect("/accessors/0/type", "VEC2", "a Draco attribute has 3 components; its accessor has 2");
}

TEST(Draco, AHeaderThatClaimsTooMuchIsRefusedBeforeDecoding) {
  const GlbBuilder good = draco_scene(false);
  const auto with_bytes = [&](std::size_t at, const test::Bytes& bytes) {
    GlbBuilder b = good;
    std::copy(bytes.begin(), bytes.end(), b.bin.begin() + static_cast<std::ptrdiff_t>(at));
    return draco_error(b);
  };
  const auto expect = [](const std::string& error, const std::string& words) {
    EXPECT_NE(error.find(words), std::string::npos) << error;
  };
  // Behind the header of 11 bytes stand the numbers of triangles and of vertices.
  expect(with_bytes(11, {0xFF, 0xFF, 0xFF, 0x7F}), "its Draco data have 805306365 indices");
  expect(with_bytes(12, {0xFF, 0xFF, 0xFF, 0x7F}), "its Draco data have 268435455 vertices");
  expect(with_bytes(0, {'d'}), "its data are not of Draco");
  expect(with_bytes(5, {1, 1}), "bitstream 1.1; allowed: 2.2");
  expect(with_bytes(7, {0}), "are a point cloud");
  expect(with_bytes(10, {0x80}), "have metadata");
  GlbBuilder grid = good;
  grid.json["accessors"][2]["count"] = 60000000;
  for (const int a : {0, 1}) grid.json["accessors"][a]["count"] = 30000000;
  const test::Bytes twenty_million{0x80, 0xDA, 0xC4, 0x09};
  std::copy(twenty_million.begin(), twenty_million.end(), grid.bin.begin() + 11);
  expect(draco_error(grid), "claims 20000000 triangles and 30000000 vertices in ");
}

TEST(Draco, EveryBrokenByteIsHarmless) {
  for (const bool edgebreaker : {false, true}) {
    const GlbBuilder good = draco_scene(edgebreaker);
    for (std::size_t i = 0; i < good.bin.size(); ++i) {
      GlbBuilder b = good;
      b.bin[i] = static_cast<std::uint8_t>(~b.bin[i]);
      draco_error(b);
      b.bin.resize(i + 1);
      b.json["bufferViews"][0]["byteLength"] = i + 1;
      draco_error(b);
    }
  }
}

}  // namespace
}  // namespace lacuna
