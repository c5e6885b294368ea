#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"

namespace lacuna {
namespace {

using test::GlbBuilder;
using test::load;

V3f geometric_normal(const Mesh& mesh, std::size_t triangle = 0) {
  const auto& t = mesh.triangles[triangle];
  const V3f& a = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized();
}

/// The z = 0 triangle facing +z, with its normals, under a chain of nodes (outermost first).
SceneData under(const std::vector<Json>& chain, const V3f& normal = {0, 0, 1}) {
  GlbBuilder b;
  const auto mesh =
      b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, -1, {normal, normal, normal});
  b.add_node(chain.front());
  for (std::size_t i = 1; i < chain.size(); ++i) {
    b.json["nodes"].push_back(chain[i]);
    b.json["nodes"][i - 1]["children"] = {i};
  }
  b.json["nodes"].back()["mesh"] = mesh;
  return load(b);
}

TEST(Transforms, TranslationRotationScaleInGltfOrder) {
  const double h = std::numbers::sqrt2 / 2;  // a quarter turn about z
  const auto scene =
      under({{{"translation", {10, 20, 30}}, {"rotation", {0, 0, h, h}}, {"scale", {2, 3, 4}}}});
  const auto& p = scene.meshes.at(0).positions;
  expect_near(p[0], {10, 20, 30});
  expect_near(p[1], {10, 22, 30}, 1e-5F);  // (1,0,0) -> scaled (2,0,0) -> turned (0,2,0)
  expect_near(p[2], {7, 20, 30}, 1e-5F);   // (0,1,0) -> (0,3,0) -> (-3,0,0)
}

/// A triangle of side 1, a camera and a light in its middle, all at `offset` by way of two nodes.
SceneData placed_at(const V3d& offset) {
  GlbBuilder b;
  const auto mesh =
      b.add_mesh({{-0.5F, -0.5F, 0}, {0.5F, -0.5F, 0}, {-0.5F, 0.5F, 0}}, {{0, 1, 2}});
  const Json translation{offset.x - 3, offset.y - 3, offset.z - 3};
  b.add_node({{"translation", translation}, {"children", {1, 2, 3}}});
  for (const Json& node : {Json{{"mesh", mesh}, {"translation", {3, 3, 3}}},
                           Json{{"camera", 0}, {"translation", {3.25, 3.25, 4}}},
                           Json{{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}},
                                {"translation", {3.25, 3.25, 3.5}}}}) {
    b.json["nodes"].push_back(node);
  }
  b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 0.1}}}}};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  return load(b);
}

TEST(Origin, AFarSceneIsMovedToIt) {
  const SceneData near = placed_at({20, -30, 15});  // ratios up to 30
  EXPECT_EQ(near.origin, V3d(0, 0, 0));
  EXPECT_EQ(near.meshes.at(0).positions[0], V3f(19.5F, -30.5F, 15));
  const SceneData at = placed_at({0, 0, 0});
  for (const V3d& offset : {V3d(1e5, 0, 0), V3d(1e7, -1e7, 1e7), V3d(1e12, 0, 3), V3d(0, 64, 0)}) {
    const SceneData far = placed_at(offset);
    SCOPED_TRACE(offset.x);
    EXPECT_EQ(far.origin, offset) << "a multiple of 1, and so exact";
    EXPECT_EQ(far.meshes.at(0).positions, at.meshes.at(0).positions);
    EXPECT_EQ(far.cameras.at(0).to_world, at.cameras.at(0).to_world);
    EXPECT_EQ(far.lights.at(0).position, at.lights.at(0).position);
    EXPECT_EQ(far.geometry_hash, at.geometry_hash);
    EXPECT_TRUE(far.warnings.empty());
  }
  const SceneData odd = placed_at({1e6 + 0.3, 0, 0});
  EXPECT_EQ(odd.origin, V3d(1e6, 0, 0));
  EXPECT_FLOAT_EQ(odd.meshes.at(0).positions[0].x, -0.2F);
}

TEST(Origin, WhatAFloatCannotResolveIsWarnedOf) {
  const auto said = [](const SceneData& scene) {
    std::string all;
    for (const std::string& w : scene.warnings) all += w;
    return all;
  };
  GlbBuilder b;
  const auto small = b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  b.add_node({{"mesh", small}, {"name", "speck"}});
  b.add_node({{"mesh", small}, {"translation", {3e4, 0, 0}}});
  const std::string places = said(load(b));
  EXPECT_NE(places.find("1 of 2 meshes are too small for their distance"), std::string::npos);
  EXPECT_NE(places.find("is 1 wide at a distance of 3e+04"), std::string::npos) << places;

  GlbBuilder seen = test::triangle_scene();
  seen.add_camera("here", {0, 0, 1e4F}, 0.8);
  EXPECT_EQ(said(load(seen)), "");
  seen.add_camera("there", {0, 0, 2e6F}, 0.8);
  EXPECT_EQ(said(load(seen)),
            "camera \"there\" is 2e+06 from the middle of a scene 1 wide: its place is rounded by "
            "0.1");

  GlbBuilder baked;
  const auto far = baked.add_mesh({{1e6, 0, 0}, {1e6 + 1, 0, 0}, {1e6, 1, 0}}, {{0, 1, 2}});
  baked.add_node({{"mesh", far}});
  const SceneData scene = load(baked);
  EXPECT_NEAR(scene.origin.x, 1e6, 1);
  EXPECT_NE(said(scene).find("1 of 1 meshes have coordinates in the file"), std::string::npos);
}

TEST(Transforms, MatrixIsColumnMajorAndParentsComeLast) {
  const Json shear{{"matrix", {1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 1, 0, 7, 8, 9, 1}}};
  const auto scene = under({{{"scale", {2, 2, 2}}}, shear});
  const auto& p = scene.meshes.at(0).positions;
  expect_near(p[0], {14, 16, 18});
  expect_near(p[2], {15, 18, 18});  // (0,1,0) -> (0.5,1,0) + (7,8,9), doubled
}

TEST(Transforms, AMirroredNodeKeepsItsFrontAndItsNormals) {
  for (const Json& scale : {Json{1, 1, 1}, Json{-1, 1, 1}, Json{-1, -2, 1}, Json{-1, -2, -3}}) {
    const auto scene = under({{{"scale", scale}}});
    const Mesh& mesh = scene.meshes.at(0);
    const float front = scale[2].get<float>() < 0 ? -1.0F : 1.0F;
    expect_near(geometric_normal(mesh), {0, 0, front});
    for (const V3f& n : mesh.normals) expect_near(n, {0, 0, front});
  }
}

TEST(Transforms, NormalsGoWithTheInverseTranspose) {
  // The plane x + z = 0 stretched twofold along z becomes 2x + z = 0.
  GlbBuilder b;
  const V3f n = V3f(1, 0, 1).normalized();
  const auto mesh = b.add_mesh({{0, 0, 0}, {0, 1, 0}, {-1, 0, 1}}, {{0, 1, 2}}, -1, {n, n, n});
  b.add_node({{"mesh", mesh}, {"scale", {1, 1, 2}}});
  const auto scene = load(b);
  expect_near(scene.meshes.at(0).normals[0], V3f(2, 0, 1).normalized());
  expect_near(geometric_normal(scene.meshes[0]), V3f(2, 0, 1).normalized());
}

TEST(Transforms, ExtremeScalesKeepNormalsAndTriangles) {
  for (const double s : {1e-12, 1e-4, 1e5, 1e14}) {
    const auto scene = under({{{"scale", {s, s, s}}}});
    EXPECT_EQ(scene.triangle_count(), 1U) << s;
    expect_near(scene.meshes.at(0).normals[0], {0, 0, 1});
  }
}

TEST(Transforms, CamerasAndLightsLoseScaleButNotDirection) {
  GlbBuilder b = test::triangle_scene();
  const double h = std::numbers::sqrt2 / 2;  // a quarter turn about y: -z becomes -x
  b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  b.add_node({{"camera", 0},
              {"name", "cam"},
              {"rotation", {0, h, 0, h}},
              {"scale", {5, 6, 7}},
              {"translation", {1, 2, 3}}});
  b.add_light(
      {{"type", "spot"}, {"intensity", 4}, {"color", {1, 0.5, 0}}, {"spot", Json::object()}},
      {{"rotation", {0, h, 0, h}}, {"scale", {5, 6, 7}}, {"translation", {1, 2, 3}}});
  const auto scene = load(b);
  const CameraData& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.name, "cam");
  const auto row = [&camera](int i) {
    return V3f(V3d(camera.to_world[i][0], camera.to_world[i][1], camera.to_world[i][2]));
  };
  expect_near(row(0), {0, 0, -1});
  expect_near(row(1), {0, 1, 0});
  expect_near(row(2), {1, 0, 0});
  expect_near(row(3), {1, 2, 3});
  const PunctualLight& light = scene.lights.at(0);
  expect_near(light.direction, {-1, 0, 0});
  expect_near(light.position, {1, 2, 3});
  EXPECT_EQ(light.intensity, Rgb(4, 2, 0));
  EXPECT_EQ(light.inner_cone, 0.0F);
  EXPECT_NEAR(light.outer_cone, std::numbers::pi / 4, 1e-6);
}

TEST(Lights, SpotsMayHaveAHardEdge) {
  const auto cones = [](double inner, double outer) {
    GlbBuilder b = test::triangle_scene();
    b.add_light({{"type", "spot"},
                 {"name", "beam"},
                 {"spot", {{"innerConeAngle", inner}, {"outerConeAngle", outer}}}});
    return load(b);
  };
  const SceneData equal = cones(0.5, 0.5);
  EXPECT_EQ(equal.lights.at(0).inner_cone, equal.lights.at(0).outer_cone);
  EXPECT_TRUE(equal.warnings.empty());
  const SceneData by_a_hair = cones(0.50001, 0.5);
  EXPECT_EQ(by_a_hair.lights.at(0).inner_cone, 0.5F);
  ASSERT_EQ(by_a_hair.warnings.size(), 1U);
  for (const char* word :
       {"lights[0].spot", "innerConeAngle 0.50001", "outerConeAngle 0.5", "hard edge"}) {
    EXPECT_NE(by_a_hair.warnings[0].find(word), std::string::npos) << by_a_hair.warnings[0];
  }
  const SceneData narrow = cones(0, 1e-7);
  ASSERT_EQ(narrow.warnings.size(), 1U);
  EXPECT_NE(narrow.warnings[0].find("outerConeAngle 1e-07"), std::string::npos);
}

/// Five points of a zigzag; the strip's triangles all face +z.
const std::vector<V3f> zigzag{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};

TEST(Primitives, StripsAndFansKeepTheirWinding) {
  GlbBuilder b;
  const auto strip = b.add_mesh(zigzag, {});
  b.json["meshes"][strip]["primitives"][0]["mode"] = 5;
  const auto fan = b.add_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {});
  b.json["meshes"][fan]["primitives"][0]["mode"] = 6;
  b.add_node({{"mesh", strip}});
  b.add_node({{"mesh", fan}});
  const auto scene = load(b);
  ASSERT_EQ(scene.meshes.size(), 2U);
  EXPECT_EQ(scene.meshes[0].triangles.size(), 3U);
  EXPECT_EQ(scene.meshes[1].triangles.size(), 2U);
  for (const Mesh& mesh : scene.meshes) {
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      expect_near(geometric_normal(mesh, t), {0, 0, 1});
    }
  }
}

TEST(Primitives, EveryIndexTypeReadsTheSame) {
  const auto with = [](auto type, int component) {
    using Index = decltype(type);
    GlbBuilder b;
    const auto mesh = b.add_mesh(zigzag, {});
    b.json["meshes"][mesh]["primitives"][0]["indices"] =
        b.add_accessor(std::vector<Index>{0, 1, 2, 2, 1, 3}, component, "SCALAR");
    b.add_node({{"mesh", mesh}});
    return load(b);
  };
  const auto u8 = with(std::uint8_t{}, 5121);
  const auto u16 = with(std::uint16_t{}, 5123);
  const auto u32 = with(std::uint32_t{}, 5125);
  ASSERT_EQ(u8.triangle_count(), 2U);
  EXPECT_EQ(u8.meshes[0].positions.size(), 4U) << "the vertex nobody uses is left out";
  EXPECT_EQ(u8.meshes[0].triangles[1], (std::array<std::uint32_t, 3>{2, 1, 3}));
  EXPECT_EQ(u8.geometry_hash, u16.geometry_hash);
  EXPECT_EQ(u8.geometry_hash, u32.geometry_hash);
}

TEST(Primitives, OutOfRangeIndicesAreRefused) {
  GlbBuilder b;
  b.add_node({{"mesh", b.add_mesh(zigzag, {{0, 1, 2}, {1, 5, 3}})}, {"name", "n"}});
  try {
    load(b);
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(
        std::string(e.what()).find("meshes[0].primitives[0] under nodes[0] \"n\": indices[4] is "
                                   "5; allowed: below 5"),
        std::string::npos)
        << e.what();
  }
}

TEST(Primitives, InterleavedAndNormalisedAttributes) {
  GlbBuilder b;
  struct Vertex {
    V3f position;
    std::array<std::uint8_t, 4> uv;
  };
  const auto view = b.add_view(std::vector<Vertex>{
      {{0, 0, 0}, {0, 255, 0, 0}}, {{1, 0, 0}, {51, 0, 0, 0}}, {{0, 1, 0}, {255, 102, 0, 0}}});
  b.json["bufferViews"][view]["byteStride"] = 16;
  b.json["accessors"] = {
      {{"bufferView", view}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
      {{"bufferView", view},
       {"byteOffset", 12},
       {"componentType", 5121},
       {"count", 3},
       {"type", "VEC2"},
       {"normalized", true}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["images"] = {{{"bufferView", view}}};
  b.add_material(
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}}}});
  b.json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", 0}, {"TEXCOORD_1", 1}}}, {"material", 0}}}}}};
  b.add_node({{"mesh", 0}});
  const auto scene = load(b);
  const Mesh& mesh = scene.meshes.at(0);
  EXPECT_TRUE(mesh.uvs[0].empty());
  ASSERT_EQ(mesh.uvs[1].size(), 3U);
  EXPECT_EQ(mesh.uvs[1][0], V2f(0, 1));
  EXPECT_EQ(mesh.uvs[1][1], V2f(0.2F, 0));
  EXPECT_EQ(mesh.uvs[1][2], V2f(1, 0.4F));
}

TEST(Dropping, NonFiniteVerticesTakeOnlyTheirTriangles) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float inf = std::numeric_limits<float>::infinity();
  GlbBuilder b;
  const auto mesh = b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {nan, 0, 0}, {0, inf, 0}},
                               {{0, 1, 3}, {0, 1, 2}, {4, 1, 2}});
  b.add_node({{"mesh", mesh}});
  const auto scene = load(b);
  EXPECT_EQ(scene.triangle_count(), 1U);
  EXPECT_EQ(scene.dropped_triangles, 2U);
  EXPECT_EQ(scene.meshes.at(0).positions.size(), 3U);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.warnings[0],
            "triangles dropped: 0 of zero area, 2 with a vertex that is not finite");
}

/// A repeated corner, three points on a line, and a sliver thinner than floats; then a needle, a
/// sliver that floats can tell from a line, and a plain triangle, which stay.
TEST(Dropping, ZeroAreaAtEveryScaleAndPlace) {
  const std::vector<V3f> points{{0, 0, 0},     {1, 0, 0},     {0, 1, 0},    {2, 0, 0},
                                {2, 1e-8F, 0}, {0, 0, 1e-6F}, {2, 3e-6F, 0}};
  const test::Triangles triangles{{0, 0, 1}, {0, 1, 3}, {0, 1, 4}, {0, 1, 5}, {0, 1, 6}, {0, 1, 2}};
  for (const double s : {1e-4, 1.0, 1e5}) {
    GlbBuilder b;
    b.add_node({{"mesh", b.add_mesh(points, triangles)}, {"scale", {s, s, s}}});
    const auto scene = load(b);
    EXPECT_EQ(scene.dropped_triangles, 3U) << "scale " << s;
    EXPECT_EQ(scene.triangle_count(), 3U) << "scale " << s;
  }
}

TEST(Dropping, NothingLeftIsRefused) {
  GlbBuilder b;
  b.add_node({{"mesh", b.add_mesh({{0, 0, 0}, {1, 1, 1}}, {{0, 1, 0}})}});
  try {
    load(b);
    FAIL();
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("no triangles (dropped: 1 of zero area"),
              std::string::npos)
        << e.what();
  }
}

TEST(Normals, UnusableOnesBecomeGeometric) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  for (const V3f& bad : {V3f(0, 0, 0), V3f(nan, 0, 1)}) {
    GlbBuilder b;
    const V3f tilted = V3f(0, 0.6F, 0.8F);
    const auto mesh =
        b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, -1, {tilted * 5, bad, tilted});
    b.add_node({{"mesh", mesh}, {"scale", {1, 1, -1}}});
    const auto scene = load(b);
    const auto& n = scene.meshes.at(0).normals;
    expect_near(n[0], {0, 0.6F, -0.8F});
    expect_near(n[1], {0, 0, -1});
    ASSERT_EQ(scene.warnings.size(), 1U);
    EXPECT_EQ(scene.warnings[0].substr(0, 9), "1 normals");
  }
}

TEST(Scenes, DefaultFirstOrAllRoots) {
  GlbBuilder b = test::triangle_scene();
  b.json["nodes"].push_back({{"mesh", 0}});
  b.json["nodes"].push_back({{"mesh", 0}});
  b.json["scenes"].push_back({{"nodes", {1, 2}}});
  EXPECT_EQ(load(b).triangle_count(), 1U);
  b.json["scene"] = 1;
  EXPECT_EQ(load(b).triangle_count(), 2U);
  b.json.erase("scene");
  EXPECT_EQ(load(b).triangle_count(), 1U);
  b.json.erase("scenes");
  EXPECT_EQ(load(b).triangle_count(), 3U);
}

TEST(Scenes, WhatIsLeftOutIsSaidOnce) {
  GlbBuilder b = test::triangle_scene();
  Json& primitives = b.json["meshes"][0]["primitives"];
  Json primitive = primitives[0];
  primitive["attributes"]["COLOR_1"] = 0;
  primitive["targets"] = {{{"POSITION", 0}}};
  Json lines = primitive;
  lines["mode"] = 1;
  primitives = {primitive, lines, primitive};
  b.json["extensionsUsed"] = {"KHR_materials_dispersion", "KHR_materials_ior"};
  b.json["skins"] = {{{"joints", {0}}}};
  b.add_node({{"mesh", 0}, {"skin", 0}});
  b.json["animations"] = {{{"channels", {{{"sampler", 0}, {"target", {{"path", "scale"}}}}}},
                           {"samplers", {{{"input", 0}, {"output", 0}}}}}};
  const auto scene = load(b);
  EXPECT_EQ(scene.triangle_count(), 4U);
  for (const std::string what : {"COLOR_1", "JOINTS_0 or WEIGHTS_0", "points or lines",
                                 "KHR_materials_dispersion", "animations"}) {
    EXPECT_EQ(
        std::count_if(scene.warnings.begin(), scene.warnings.end(),
                      [&](const std::string& w) { return w.find(what) != std::string::npos; }),
        1)
        << what;
  }
  EXPECT_EQ(scene.warnings.size(), 5U);
}

TEST(Hashes, GeometryChangesWithPositionsAndIndicesOnly) {
  GlbBuilder b = test::triangle_scene();
  const auto before = load(b);
  b.add_material({{"emissiveFactor", {1, 1, 1}}});
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  const auto painted = load(b);
  EXPECT_EQ(before.geometry_hash, painted.geometry_hash);
  EXPECT_NE(before.content_hash, painted.content_hash);
  b.json["nodes"][0]["translation"] = {0, 0, 1};
  EXPECT_NE(load(b).geometry_hash, painted.geometry_hash);
}

}  // namespace
}  // namespace lacuna
