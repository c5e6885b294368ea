// What other programs write and glTF does not quite allow: it opens, with a warning.

#include <gtest/gtest.h>

#include "renderer/scene/camera.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/gltf/scene_promises.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::GlbBuilder;
using test::load;

std::string warnings_of(const SceneData& scene) {
  std::string all;
  for (const std::string& w : scene.warnings) all += w + "\n";
  return all;
}

void expect_warning(const SceneData& scene, const std::string& part) {
  EXPECT_NE(warnings_of(scene).find(part), std::string::npos) << part << "\n" << warnings_of(scene);
}

/// triangle_scene() with a material, a camera and a point light.
GlbBuilder small_scene(const Json& material = Json::object()) {
  GlbBuilder b = test::triangle_scene();
  b.add_material(material);
  b.json["meshes"][0]["primitives"][0]["material"] = 0;
  return b;
}

/// Two triangles of which one is in the plane z = 0, under nodes of these scales (outermost first).
SceneData box_under(const std::vector<Json>& chain) {
  GlbBuilder b = test::triangle_scene();
  const V3f side(0, -1, 0);
  const V3f top = V3f(1, 0, 1).normalized();
  const auto mesh = b.add_mesh({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 1}, {1, 0, 0}, {0, 1, 1}},
                               {{0, 1, 2}, {3, 4, 5}}, -1, {side, side, side, top, top, top});
  b.add_node(chain.front());
  for (std::size_t i = 1; i < chain.size(); ++i) {
    b.json["nodes"].push_back(chain[i]);
    b.json["nodes"][i]["children"] = {i + 1};
  }
  b.json["nodes"].back()["mesh"] = mesh;
  SceneData scene = load(b);
  EXPECT_EQ(test::broken_promise(scene), "");
  return scene;
}

TEST(ScaleZero, HidesTheMeshesBelowIt) {
  const Json turned{{"rotation", {0.6, 0, 0, 0.8}}, {"scale", {2, 3, 4}}};
  const Json line{{"matrix", {1, 2, 3, 0, 2, 4, 6, 0, -1, -2, -3, 0, 7, 8, 9, 1}}};
  for (const Json& scale : {Json{0, 0, 0}, Json{0, 0, 1}, Json{0, -1, 0}}) {
    for (const std::vector<Json>& chain :
         {std::vector<Json>{{{"scale", scale}}}, {turned, {{"scale", scale}}, turned}}) {
      const SceneData scene = box_under(chain);
      EXPECT_EQ(scene.triangle_count(), 1U) << scale;
      EXPECT_EQ(scene.dropped_triangles, 0U) << scale;
      EXPECT_EQ(scene.bounds().high, V3f(1, 1, 0)) << "nor does it move the bounds";
      expect_warning(scene, ": its scale is 0; the meshes at and below it are left out");
      expect_warning(scene, "left out: 1 meshes under a scale of 0");
    }
  }
  EXPECT_EQ(box_under({line}).triangle_count(), 1U);
}

TEST(ScaleZero, AlongOneAxisFlattens) {
  // Of the box's two triangles the one beside the plane becomes a line.
  for (const Json& scale : {Json{1, 1, 0}, Json{1, -1, 0}, Json{2, 1, -0.0}}) {
    const SceneData scene = box_under({{{"scale", scale}, {"translation", {0, 0, 5}}}});
    ASSERT_EQ(scene.triangle_count(), 2U) << scale;
    EXPECT_EQ(scene.dropped_triangles, 1U);
    const Mesh& flat = scene.meshes.at(1);
    EXPECT_TRUE(flat.normals.empty()) << "flat: the plane's";
    for (const V3f& p : flat.positions) EXPECT_EQ(p.z, 5.0F);
    // The front stays where a scale just above 0 would have it: its normal was (1, 0, 1) / sqrt 2.
    const auto& t = flat.triangles.at(0);
    const V3f& a = flat.positions[t[0]];
    EXPECT_GT((flat.positions[t[1]] - a).cross(flat.positions[t[2]] - a).z, 0) << scale;
    expect_warning(scene, "nodes[1]: its scale is 0 along one axis");
  }
  const Json tilt{{"rotation", {0.6, 0, 0, 0.8}}};
  const Json plane{{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 0, 1}}};
  for (const std::vector<Json>& chain :
       {std::vector<Json>{tilt, {{"scale", {1, 1, 0}}}, tilt}, {tilt, plane, tilt}}) {
    EXPECT_GE(box_under(chain).triangle_count(), 2U);
  }
}

TEST(ScaleZero, LeavesCamerasAndLights) {
  const auto below = [](const Json& hidden) {
    GlbBuilder b = test::triangle_scene();
    b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.8}, {"znear", 1}}}}};
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", Json::object()}}, {{"type", "point"}}};
    b.add_node(hidden);
    b.json["nodes"][1]["children"] = {2, 3, 4};
    const Json turn{0, 0.6, 0, 0.8}, shift{1, 2, 3};
    b.json["nodes"].push_back({{"camera", 0}, {"rotation", turn}, {"translation", shift}});
    for (const int light : {0, 1}) {
      b.json["nodes"].push_back({{"rotation", turn},
                                 {"translation", shift},
                                 {"extensions", {{"KHR_lights_punctual", {{"light", light}}}}}});
    }
    return load(b);
  };
  const SceneData shown = below({{"scale", {2, 2, -2}}, {"translation", {0, 0, 7}}});
  const SceneData hidden = below({{"scale", {0, 2, -2}}, {"translation", {0, 0, 7}}});
  ASSERT_EQ(hidden.cameras.size(), 1U);
  ASSERT_EQ(hidden.lights.size(), 2U);
  EXPECT_EQ(test::broken_promise(hidden), "");
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(hidden.cameras[0].to_world[2][k],
                below({{"scale", {1, 2, -2}}}).cameras[0].to_world[2][k], 1e-12);
  }
  EXPECT_EQ(hidden.lights[0].position, V3f(0, 4, 1)) << "as its parent places it";
  EXPECT_EQ(shown.lights[0].position, V3f(2, 4, 1));
  EXPECT_NEAR(hidden.lights[0].direction.length(), 1, 1e-6);
  expect_warning(hidden, "nodes[1]: its scale is 0, which does not hide the cameras and lights");
  // A matrix does not tell what its scale was.
  const SceneData flat = below({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 7, 1}}});
  EXPECT_TRUE(flat.cameras.empty());
  ASSERT_EQ(flat.lights.size(), 1U) << "a point light needs no direction";
  EXPECT_EQ(flat.lights[0].position, V3f(1, 2, 7));
  expect_warning(flat, "nodes[2]: its matrix is singular and gives its camera no direction");
}

TEST(AHairOutside, IsClampedWithAWarning) {
  GlbBuilder b =
      small_scene({{"pbrMetallicRoughness",
                    {{"baseColorFactor", {1.0000001, -1e-9, 1.005, 1.0000001}},
                     {"metallicFactor", -1e-9},
                     {"roughnessFactor", 1.009}}},
                   {"alphaCutoff", -1e-12},
                   {"extensions",
                    {{"KHR_materials_ior", {{"ior", 0.9999}}},
                     {"KHR_materials_emissive_strength", {{"emissiveStrength", -1e-9}}},
                     {"KHR_materials_transmission", {{"transmissionFactor", 1.0000001}}},
                     {"KHR_materials_specular",
                      {{"specularFactor", 1.0000001}, {"specularColorFactor", {1, -1e-9, 1}}}}}}});
  b.add_light({{"type", "point"}, {"color", {1.0000001, 0.5, -1e-9}}});
  b.json["nodes"][0]["rotation"] = {0, 0, 0, 1.005};
  const SceneData scene = load(b);
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.base_color, Rgb(1, 0, 1));
  EXPECT_EQ(m.alpha, 1.0F);
  EXPECT_EQ(m.metallic, 0.0F);
  EXPECT_EQ(m.roughness, 1.0F);
  EXPECT_EQ(m.alpha_cutoff, 0.0F);
  EXPECT_EQ(m.ior, 1.0F);
  EXPECT_EQ(m.transmission, 1.0F);
  EXPECT_EQ(m.specular, 1.0F);
  EXPECT_EQ(m.specular_color, Rgb(1, 0, 1));
  EXPECT_EQ(scene.lights.at(0).intensity.z, 0.0F);
  expect_near(scene.meshes.at(0).positions[1], {1, 0, 0});
  expect_warning(scene,
                 "materials[0].pbrMetallicRoughness: baseColorFactor[0]: found number 1.0000001; "
                 "allowed: a number from 0 to 1; it is read as 1 (and so for 3 others)");
  expect_warning(scene, "ior: found number 0.9999; allowed: a number from 1");
}

TEST(AHairOutside, MoreLightThanGltfAllowsIsMoreLight) {
  GlbBuilder b = small_scene({{"emissiveFactor", {3, 1, 0}}});
  b.add_light({{"type", "point"}, {"color", {1.2, 1, 0.5}}, {"intensity", 10}});
  const SceneData scene = load(b);
  EXPECT_EQ(scene.lights.at(0).intensity, Rgb(12, 10, 5));
  EXPECT_EQ(scene.materials.at(0).emission, Rgb(3, 1, 0));
  expect_warning(scene, "lights[0]: color: found components up to 1.2; glTF allows up to 1");
  expect_warning(scene, "materials[0]: emissiveFactor: found components up to 3");
}

TEST(AHairOutside, TheFourthRowOfAMatrixMayBeRounded) {
  for (const double off : {1e-12, -1e-7, 5e-6}) {
    GlbBuilder b = test::triangle_scene();
    b.json["nodes"][0]["matrix"] = {2, 0, 0, off, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1 + off};
    const SceneData scene = load(b);
    EXPECT_EQ(scene.meshes.at(0).positions[1], V3f(2, 0, 0));
    expect_warning(scene, "nodes[0] \"thing\": the fourth row of matrix is ");
  }
}

TEST(AHairOutside, SpareCornersAreLeftOut) {
  for (const auto& [mode, indices, triangles] :
       {std::tuple(4, std::vector<std::uint32_t>{0, 1, 2, 2, 1}, 1U),
        {4, {0, 1, 2, 0}, 1U},
        {4, {0, 1}, 0U},
        {5, {0, 1}, 0U},
        {6, {0}, 0U}}) {
    GlbBuilder b = test::triangle_scene();
    b.add_node({{"mesh", 0}});
    const auto mesh = b.add_mesh({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {});
    b.json["meshes"][mesh]["primitives"][0]["indices"] = b.add_accessor(indices, 5125, "SCALAR");
    b.json["meshes"][mesh]["primitives"][0]["mode"] = mode;
    b.add_node({{"mesh", mesh}});
    const SceneData scene = load(b);
    EXPECT_EQ(scene.triangle_count(), 2 + triangles);
    expect_warning(scene, "meshes[1].primitives[0] under nodes[2]: the last " +
                              std::to_string(indices.size() - 3 * triangles) + " corners");
  }
}

TEST(Uris, ABackslashIsASlashInsideOfTheFolder) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "scene/tex");
  folder.write("scene/tex/a.bin", test::triangle_scene().bin);
  folder.write("a.bin", test::triangle_scene().bin);
  const auto open = [&](const std::string& uri) {
    return load_gltf(folder.write("scene/scene.gltf", test::triangle_scene().gltf(uri)));
  };
  for (const char* uri : {"tex\\a.bin", "tex%5Ca.bin", ".\\tex%5ca.bin"}) {
    EXPECT_EQ(open(uri).triangle_count(), 1U) << uri;
  }
  for (const char* uri :
       {"..\\a.bin", "%2e%2e%5ca.bin", "tex\\..\\..\\a.bin", "\\a.bin", "C:\\a.bin"}) {
    EXPECT_THROW(open(uri), SceneError) << uri;
  }
}

TEST(Images, OneThatIsNotUsedMayBeOfAnyKind) {
  for (const Json& image :
       {Json{{"uri", "data:image/webp;base64,UklGRg=="}}, Json{{"uri", "missing.ktx2"}},
        Json{{"uri", "missing.avif"}, {"mimeType", "image/avif"}},
        Json{{"bufferView", 0}, {"mimeType", "image/ktx2"}}}) {
    GlbBuilder b;
    const auto texture = b.add_texture(test::encode8(1, 1, 3, {255, 0, 0}));
    b.json["images"].push_back(image);
    b.json["textures"][texture]["extensions"]["KHR_texture_basisu"]["source"] = 1;
    const auto material =
        b.add_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
    b.add_node({{"mesh", b.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, static_cast<int>(material))}});
    EXPECT_EQ(load(b).textures.size(), 1U) << image;
    b.json["textures"][texture].erase("source");
    try {
      load(b);
      ADD_FAILURE() << image;
    } catch (const SceneError& e) {
      EXPECT_NE(std::string(e.what()).find("only what extension KHR_texture_basisu gives"),
                std::string::npos)
          << e.what();
    }
  }
}

TEST(Images, AWebpIsReadFromADataUri) {
  const auto webp =
      test::read_bytes(std::string(LACUNA_SOURCE_DIR) + "/tests/fuzz/corpus/texture/lossless.webp");
  constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string base64;
  for (std::size_t i = 0; i < webp.size(); i += 3) {
    std::uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < webp.size() ? webp[i + k] : 0U);
    for (int k = 3; k >= 0; --k) base64 += digits[three >> (6 * k) & 63];
  }
  for (std::size_t k = webp.size(); k % 3 != 0; ++k) base64[base64.size() - 3 + k % 3] = '=';
  GlbBuilder b;
  const auto texture = b.add_texture(webp);
  const auto material =
      b.add_material({{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  b.add_node({{"mesh", b.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, static_cast<int>(material))}});
  const auto texels = [&] {
    SceneData scene = load(b);
    scene.textures.at(0)->decode();
    return std::pair(scene.textures[0]->size(), scene.textures[0]->lookup({0.3F, 0.6F}).rgb);
  };
  const auto from_view = texels();
  b.json["images"][0] = {{"uri", "data:image/webp;base64," + base64}};
  EXPECT_EQ(texels(), from_view);
  b.json["images"][0]["uri"] = "data:image/avif;base64," + base64;
  EXPECT_THROW(load(b), SceneError);
}

TEST(Compression, WhereTheFallbackHasDataTheyAreRead) {
  GlbBuilder b = test::triangle_scene();
  b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}, {"attributes", {{"POSITION", 0}}}};
  b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
  b.json["extensionsUsed"] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression"};
  const SceneData scene = load(b);
  EXPECT_EQ(scene.triangle_count(), 1U);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(Cameras, NodesThatShareOneAreToldApart) {
  GlbBuilder b = test::triangle_scene();
  b.json["cameras"] = {
      {{"type", "perspective"}, {"name", "cam"}, {"perspective", {{"yfov", 0.8}, {"znear", 1}}}}};
  for (const auto& [name, x] : {std::pair("left", -1), {"right", 1}, {"right", 2}}) {
    b.add_node({{"camera", 0}, {"name", name}, {"translation", {x, 0, 5}}});
  }
  const SceneData scene = load(b);
  const auto x_of = [&](const std::string& name) {
    return choose_camera(scene, name, "scene.glb").to_world[3][0];
  };
  EXPECT_EQ(x_of(""), -1);
  EXPECT_EQ(x_of("cam"), -1);
  EXPECT_EQ(x_of("left"), -1);
  EXPECT_EQ(x_of("right"), 1);
  EXPECT_EQ(x_of("nodes[3]"), 2);
  EXPECT_THROW(x_of("middle"), SceneError);
  expect_warning(scene,
                 "nodes[2] \"right\": another camera is called \"cam\", too; this one is called "
                 "\"right\"");
}

}  // namespace
}  // namespace lacuna
