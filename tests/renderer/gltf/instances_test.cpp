#include <gtest/gtest.h>

#include <array>

#include "renderer/core/scene_error.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/geometry/triangle_shape.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::component_float;
using test::GlbBuilder;
using test::Triangles;

/// A comb of `teeth` triangles from (0, 0, 0) along x, of normal +z.
std::size_t add_comb(GlbBuilder& b, int teeth, int material = -1) {
  std::vector<V3f> positions;
  Triangles triangles;
  for (int i = 0; i < teeth; ++i) {
    const auto at = static_cast<float>(i);
    const auto first = static_cast<std::uint32_t>(positions.size());
    positions.insert(positions.end(), {{at, 0, 0}, {at + 1, 0, 0}, {at, 1, 0}});
    triangles.push_back({first, first + 1, first + 2});
  }
  return b.add_mesh(positions, triangles, material);
}

constexpr int many = 1 << 16;  // triangles: 20 copies have more than 2^20

/// A comb on 20 nodes, of which the second is turned over and the third is mirrored.
GlbBuilder combs(int teeth) {
  GlbBuilder b;
  const auto comb = add_comb(b, teeth);
  for (int i = 0; i < 20; ++i) {
    Json node = {{"mesh", comb}, {"name", "comb"}, {"translation", {0, i, 0}}};
    if (i == 1) node["rotation"] = {1, 0, 0, 0};
    if (i == 2) node["scale"] = {1, 1, -1};
    b.add_node(node);
  }
  return b;
}

/// The corners in the scene of the first triangle of an instance.
std::array<V3f, 3> first_triangle(const SceneData& scene, std::size_t instance) {
  const Instance& i = scene.instances.at(instance);
  const Mesh& mesh = scene.meshes_of(scene.prototypes.at(i.prototype))[0];
  return TriangleShape(TriangleShape(mesh, 0), i).corners;
}

TEST(SharedMeshes, AreCopiedUpToAMillionTriangles) {
  const SceneData scene = load(combs(1 << 10));
  EXPECT_EQ(scene.meshes.size(), 20U);
  EXPECT_TRUE(scene.instances.empty());
}

TEST(SharedMeshes, AreInstancesBeyond) {
  const SceneData scene = load(combs(many));
  ASSERT_EQ(scene.instances.size(), 20U);
  ASSERT_EQ(scene.prototypes.size(), 2U);  // one is for the mirrored node
  EXPECT_EQ(scene.meshes.size(), 2U);
  EXPECT_TRUE(scene.placed_meshes().empty());
  EXPECT_EQ(scene.triangle_count(), std::size_t{20} * many);
  EXPECT_EQ(scene.stored_triangles(), std::size_t{2} * many);
  EXPECT_EQ(first_triangle(scene, 0), (std::array<V3f, 3>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}));
  EXPECT_EQ(first_triangle(scene, 1), (std::array<V3f, 3>{{{0, 1, 0}, {1, 1, 0}, {0, 0, 0}}}));
  EXPECT_EQ(first_triangle(scene, 5), (std::array<V3f, 3>{{{0, 5, 0}, {1, 5, 0}, {0, 6, 0}}}));
  EXPECT_LE(scene.bounds().high.x, many);
  EXPECT_EQ(scene.bounds().low.y, 0);
  EXPECT_EQ(scene.bounds().high.y, 20);
}

/// A scale of -1 along z turns the front of a triangle of normal +z to -z, as for a copy.
TEST(SharedMeshes, AMirroredInstanceHasTheFrontOfACopy) {
  const auto normal_of = [](const std::array<V3f, 3>& c) { return TriangleShape(c).ng.z; };
  const SceneData instances = load(combs(many)), copies = load(combs(1));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(normal_of(first_triangle(instances, i)), TriangleShape(copies.meshes.at(i), 0).ng.z)
        << i;
  }
}

TEST(SharedMeshes, EmittersAreCopied) {
  GlbBuilder b;
  b.json["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
  const auto comb = add_comb(b, many);
  add_comb(b, 3, 0);
  Json& meshes = b.json["meshes"];
  meshes[comb]["primitives"].push_back(meshes[1]["primitives"][0]);
  for (int i = 0; i < 20; ++i) b.add_node({{"mesh", comb}, {"translation", {0, i, 0}}});
  const SceneData scene = load(b);
  EXPECT_EQ(scene.instances.size(), 20U);
  EXPECT_EQ(scene.placed_meshes().size(), 20U);
  for (const Mesh& mesh : scene.placed_meshes()) EXPECT_EQ(mesh.triangles.size(), 3U);
  EXPECT_EQ(scene.triangle_count(), std::size_t{20} * (many + 3));
}

TEST(SharedMeshes, AreCopiedUnderATransformThatFloatsDoNotInvert) {
  GlbBuilder b = combs(many);
  Json& node = b.json["nodes"][0];
  node.erase("translation");
  node["matrix"] = {1, 1, 0, 0, 1, 1.001, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  const SceneData scene = load(b);
  EXPECT_EQ(scene.instances.size(), 19U);
  EXPECT_EQ(scene.placed_meshes().size(), 1U);
}

TEST(SharedMeshes, AHashTellsPlacementsApart) {
  GlbBuilder b = combs(many);
  const auto hash = load(b).geometry_hash;
  EXPECT_EQ(load(b).geometry_hash, hash);
  b.json["nodes"][7]["translation"] = {0, 7, 1};
  EXPECT_NE(load(b).geometry_hash, hash);
}

/// Three instances by EXT_mesh_gpu_instancing, of a node at x = 100.
GlbBuilder gpu_instances() {
  GlbBuilder b;
  const auto comb = add_comb(b, 1);
  const auto at =
      b.add_accessor(std::vector<V3f>{{0, 0, 0}, {5, 0, 0}, {0, 7, 0}}, component_float, "VEC3");
  const auto scale =
      b.add_accessor(std::vector<V3f>{{1, 1, 1}, {2, 2, 2}, {0, 0, 0}}, component_float, "VEC3");
  b.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  Json node = {{"mesh", comb}, {"translation", {100, 0, 0}}};
  node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"TRANSLATION", at},
                                                                 {"SCALE", scale}};
  b.add_node(node);
  return b;
}

TEST(GpuInstancing, PlacesTheMeshOnceForEachElement) {
  const SceneData scene = load(gpu_instances());
  ASSERT_EQ(scene.meshes.size(), 2U);  // the third has a scale of 0
  EXPECT_EQ(V3d(scene.meshes[0].positions[0]) + scene.origin, V3d(100, 0, 0));
  EXPECT_EQ(V3d(scene.meshes[1].positions[1]) + scene.origin, V3d(107, 0, 0));
}

TEST(GpuInstancing, RefusesWhatDoesNotFit) {
  const auto message = [](const GlbBuilder& b) -> std::string {
    try {
      load(b);
    } catch (const SceneError& e) {
      return e.what();
    }
    return "";
  };
  const auto with = [](const Json& attributes) {
    GlbBuilder b = gpu_instances();
    b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = attributes;
    return b;
  };
  EXPECT_NE(message(with(Json::object())).find("attributes is missing"), std::string::npos);
  EXPECT_NE(message(with({{"attributes", Json::object()}})).find("none of TRANSLATION"),
            std::string::npos);
  EXPECT_NE(message(with({{"attributes", {{"TRANSLATION", 99}}}})).find("99"), std::string::npos);
  GlbBuilder b = gpu_instances();
  b.json["accessors"].back()["count"] = 2;
  EXPECT_NE(message(b).find("has 3 elements; allowed: 2"), std::string::npos) << message(b);
}

/// A few kilobytes that ask for 2^27 instances.
TEST(GpuInstancing, RefusesTooMany) {
  GlbBuilder b = gpu_instances();
  for (Json& accessor : b.json["accessors"]) {
    if (accessor["type"] != "VEC3" || accessor["count"] != 3) continue;
    accessor.erase("bufferView");
    accessor["count"] = 1 << 27;
  }
  b.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"].erase("SCALE");
  EXPECT_THROW(load(b), SceneError);
}

}  // namespace
}  // namespace lacuna
