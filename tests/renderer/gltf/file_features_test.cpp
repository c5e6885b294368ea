// Normal maps, vertex colours, blending, old and unlit materials, variants, cameras and units of
// light, as files have them.

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <regex>
#include <set>

#include "renderer/geometry/surface.h"
#include "renderer/gltf/gltf_features.h"
#include "renderer/gltf/gltf_guard.h"
#include "renderer/scene/scene.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::GlbBuilder;
using test::load;

/// A quad in the plane z = 0 from 0 to 1, facing +z, whose texture is upright; `map` is its normal.
GlbBuilder mapped_quad(const std::vector<std::uint8_t>& map, double scale = 1) {
  GlbBuilder b;
  b.add_texture(test::encode8(1, 1, 3, map));
  const auto material = b.add_material({{"normalTexture", {{"index", 0}, {"scale", scale}}}});
  const std::vector<V3f> corners{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  const auto mesh = b.add_mesh(corners, {{0, 1, 2}, {0, 2, 3}}, static_cast<int>(material),
                               std::vector<V3f>(4, V3f(0, 0, 1)), {{0, 1}, {1, 1}, {1, 0}, {0, 0}});
  b.add_node({{"mesh", mesh}});
  return b;
}

/// The surface that a ray along -z at (x, y) hits.
Surface surface_of(SceneData data, float x, float y) {
  const ThreadPool pool(1);
  const Scene scene(std::move(data), {.materials = true}, std::nullopt, pool);
  const Ray ray{V3f(x, y, 5), V3f(0, 0, -1)};
  Hit hit;
  EXPECT_TRUE(scene.rays().intersect(ray, hit));
  return scene.surface(ray, hit);
}
V3f normal_of(SceneData data) { return surface_of(std::move(data), 0.3F, 0.4F).ns; }

/// A texel that leans by 30 degrees, to the right or upwards in the image.
const std::vector<std::uint8_t> to_right{191, 128, 238}, upwards{128, 191, 238};
constexpr float byte = 0.01F;  // what 8 bits resolve

TEST(NormalMaps, RedIsRightAndGreenIsUpInTheImage) {
  expect_near(normal_of(load(mapped_quad(to_right))), {0.5F, 0, 0.866F}, byte);
  expect_near(normal_of(load(mapped_quad(upwards))), {0, 0.5F, 0.866F}, byte);
}

TEST(NormalMaps, ScaleStretchesAcross) {
  const V3f n = normal_of(load(mapped_quad(to_right, 2)));
  EXPECT_NEAR(n.x / n.z, 2 * 0.5 / 0.866, 3 * byte);
  expect_near(normal_of(load(mapped_quad(to_right, 0))), {0, 0, 1});
}

TEST(NormalMaps, TurnWithTheNodeAndWithTheCoordinates) {
  GlbBuilder b = mapped_quad(to_right);
  // A quarter turn about z takes the quad to x in [-1, 0], and the tangent to +y.
  const double h = std::numbers::sqrt2 / 2;
  b.json["nodes"][0]["rotation"] = {0, 0, h, h};
  expect_near(surface_of(load(b), -0.3F, 0.4F).ns, {0, 0.5F, 0.866F}, byte);
  // Mirrored: the image is seen from behind its plane in the file, and still leans to its right.
  b = mapped_quad(to_right);
  b.json["nodes"][0]["scale"] = {-1, 1, 1};
  expect_near(surface_of(load(b), -0.3F, 0.4F).ns, {-0.5F, 0, 0.866F}, byte);
}

TEST(NormalMaps, TangentsOfTheFileGoBeforeThoseOfTheCoordinates) {
  for (const double side : {1.0, -1.0}) {
    GlbBuilder b = mapped_quad(upwards);
    // The tangent points to +y; with w = 1 the bitangent is n x t = -x.
    const std::vector<V4f> tangents(4, V4f(0, 1, 0, static_cast<float>(side)));
    b.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] =
        b.add_accessor(tangents, test::component_float, "VEC4");
    expect_near(normal_of(load(b)), {static_cast<float>(-0.5 * side), 0, 0.866F}, byte);
    b.json["nodes"][0]["scale"] = {-1, 1, 1};
    expect_near(surface_of(load(b), -0.3F, 0.4F).ns, {static_cast<float>(0.5 * side), 0, 0.866F},
                byte);
  }
}

/// A quad under a coat, each with a map or none; where the lobe of the coat sends light from above.
V3f coat_mirror(const std::vector<std::uint8_t>& base, const std::vector<std::uint8_t>& coat) {
  GlbBuilder b = mapped_quad(base.empty() ? to_right : base);
  Json& material = b.json["materials"][0];
  if (base.empty()) material.erase("normalTexture");
  Json& layer = material["extensions"]["KHR_materials_clearcoat"];
  layer = {{"clearcoatFactor", 1}, {"clearcoatRoughnessFactor", 0.1}};
  if (!coat.empty()) {
    layer["clearcoatNormalTexture"]["index"] =
        coat == base ? 0 : b.add_texture(test::encode8(1, 1, 3, coat));
  }
  material["pbrMetallicRoughness"] = {{"baseColorFactor", {0, 0, 0, 1}}, {"metallicFactor", 1}};
  const ThreadPool pool(1);
  const Scene scene(load(b), {.materials = true}, std::nullopt, pool);
  EXPECT_EQ(scene.data().materials[0].extensions.coat.own_normal, base != coat);
  const Ray ray{V3f(0.3F, 0.4F, 5), V3f(0, 0, -1)};
  Hit hit;
  EXPECT_TRUE(scene.rays().intersect(ray, hit));
  std::optional<Bsdf> bsdf;
  scene.make_bsdf(scene.surface(ray, hit), bsdf);
  const V3f above(0, 0, 1);
  V3f brightest = above;
  float most = 0;
  for (int i = 0; i < 180 * 90; ++i) {
    const float phi = pi * static_cast<float>(i % 180) / 90,
                theta = pi * static_cast<float>(i / 180) / 180;
    const V3f wi(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    const float f = bsdf->eval(above, wi, Transport::radiance).y / wi.z;
    if (f > most) most = f, brightest = wi;
  }
  return brightest;
}

TEST(NormalMaps, OfACoatAreItsOwn) {
  const V3f straight(0, 0, 1), right(0.866F, 0, 0.5F), up(0, 0.866F, 0.5F);
  const float grid = 0.04F;
  expect_near(coat_mirror({}, {}), straight, grid);
  expect_near(coat_mirror({}, to_right), right, grid);
  expect_near(coat_mirror(to_right, {}), straight, grid);
  expect_near(coat_mirror(to_right, upwards), up, grid);
  expect_near(coat_mirror(upwards, upwards), up, grid);
}

/// The only mesh of `data` as a prototype, as the reader makes one, and its instance.
SceneData as_instance(SceneData data, const M44d& to_scene, bool mirrored) {
  Mesh& mesh = data.meshes[0];
  if (mirrored) {
    for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
    for (V3f& n : mesh.normals) n = -n;
    for (V4f& t : mesh.tangents) t.w = -t.w;
  }
  data.prototypes.push_back({0, 1});
  data.instances.emplace_back(to_scene, 0);
  data.bound_ray_errors();
  return data;
}

TEST(NormalMaps, OfInstancesAreThoseOfCopies) {
  for (const bool tangents : {false, true}) {
    for (const double x : {2.0, -2.0}) {
      GlbBuilder b = mapped_quad({200, 90, 220});
      if (tangents) {
        b.json["meshes"][0]["primitives"][0]["attributes"]["TANGENT"] = b.add_accessor(
            std::vector<V4f>(4, V4f(0.6F, 0.8F, 0, -1)), test::component_float, "VEC4");
      }
      M44d to_scene;
      to_scene.setScale(V3d(x, 2, 2));
      const Surface instance =
          surface_of(as_instance(load(b), to_scene, x < 0), x < 0 ? -0.6F : 0.6F, 0.8F);
      b.json["nodes"][0]["scale"] = {x, 2, 2};
      const Surface copy = surface_of(load(b), x < 0 ? -0.6F : 0.6F, 0.8F);
      expect_near(instance.ns, copy.ns, 1e-5F);
      EXPECT_GT(std::abs(copy.ns.x), 0.1F);
    }
  }
}

TEST(NormalMaps, StayInFrontOfTheTriangle) {
  const Surface s = surface_of(load(mapped_quad({255, 128, 20})), 0.5F, 0.5F);
  EXPECT_GT(dot(s.ns, s.ng), 0.005F);
  EXPECT_NEAR(s.ns.length(), 1, 1e-5);
}

TEST(NormalMaps, CostNothingWhereNothingScatters) {
  const ThreadPool pool(1);
  const Scene scene(load(mapped_quad(to_right)), {}, std::nullopt, pool);
  EXPECT_EQ(scene.textures_decoded(), 0);
}

/// The quad with colours at its corners: components of type T that stand for 0, 1/2 and 1.
template <class T>
GlbBuilder coloured_quad(int component, const std::string& type, const std::array<T, 3>& values) {
  GlbBuilder b;
  const auto material = b.add_material(
      {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.5, 1, 1}}, {"metallicFactor", 0}}},
       {"alphaMode", "BLEND"}});
  b.add_node({{"mesh", b.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, static_cast<int>(material))}});
  const std::size_t width = type == "VEC4" ? 4 : 3;
  std::vector<T> colours;
  for (int corner = 0; corner < 4; ++corner) {
    for (std::size_t k = 0; k < width; ++k) colours.push_back(values[k == 0 ? 0 : k == 3 ? 1 : 2]);
  }
  const auto view = b.add_view(colours);
  b.json["accessors"].push_back({{"bufferView", view},
                                 {"componentType", component},
                                 {"normalized", component != test::component_float},
                                 {"count", 4},
                                 {"type", type}});
  b.json["meshes"][0]["primitives"][0]["attributes"]["COLOR_0"] = b.json["accessors"].size() - 1;
  return b;
}

TEST(VertexColours, OfEveryTypeMultiplyTheBaseColour) {
  const auto check = [](const GlbBuilder& b, float alpha) {
    SceneData data = load(b);
    ASSERT_EQ(data.meshes[0].colors.size(), 4U);
    EXPECT_NEAR(data.meshes[0].colors[0].w, alpha, byte);
    const ThreadPool pool(1);
    const Scene scene(std::move(data), {.materials = true}, std::nullopt, pool);
    const Mesh& mesh = scene.data().meshes[0];
    Hit hit;
    hit.u = hit.v = 0.25F;
    const Surface s = scene.surface(hit, (mesh.positions[0] + mesh.positions[1]) / 2.0F);
    EXPECT_NEAR(scene.coverage(s), alpha, byte);
    std::optional<Bsdf> bsdf;
    scene.make_bsdf(s, bsdf);
    const Rgb albedo = bsdf->albedo();
    EXPECT_LT(albedo.x, 0.05F);  // the coat alone
    EXPECT_NEAR((albedo.y - albedo.x) / (albedo.z - albedo.x), 0.5, 1e-3);
  };
  check(coloured_quad<float>(test::component_float, "VEC4", {0, 0.5F, 1}), 0.5F);
  check(coloured_quad<float>(test::component_float, "VEC3", {0, 0.5F, 1}), 1);
  check(coloured_quad<std::uint8_t>(test::component_u8, "VEC4", {0, 128, 255}), 0.5F);
  check(coloured_quad<std::uint16_t>(test::component_u16, "VEC4", {0, 32768, 65535}), 0.5F);
}

TEST(VertexColours, BelongToTheirMeshAndWhiteIsNotKept) {
  GlbBuilder b = coloured_quad<float>(test::component_float, "VEC4", {1, 1, 1});
  EXPECT_TRUE(load(b).meshes[0].colors.empty());
  b = coloured_quad<float>(test::component_float, "VEC4", {0, 1, 1});
  b.add_node({{"mesh", b.add_quad({5, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0)}});
  const SceneData scene = load(b);
  ASSERT_EQ(scene.meshes.size(), 2U);
  EXPECT_TRUE(scene.materials[scene.meshes[0].material].vertex_colors);
  EXPECT_FALSE(scene.materials[scene.meshes[1].material].vertex_colors);
}

TEST(VertexColours, BeyondTheirRangeAreClampedAndNonsenseIsRefused) {
  const SceneData scene =
      load(coloured_quad<float>(test::component_float, "VEC4", {-0.01F, 0.5F, 1.25F}));
  EXPECT_EQ(scene.meshes[0].colors[0], V4f(0, 1, 1, 0.5F));
  ASSERT_FALSE(scene.warnings.empty());
  EXPECT_NE(scene.warnings[0].find("COLOR_0 of vertex 0 has -0.01"), std::string::npos);
  EXPECT_THROW(load(coloured_quad<float>(test::component_float, "VEC3", {NAN, 0, 1})), SceneError);
}

/// A quad of one material.
GlbBuilder quad_of(const Json& material) {
  GlbBuilder b;
  b.add_texture(test::encode8(1, 1, 4, {255, 128, 0, 102}));
  b.add_node({{"mesh", b.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                  static_cast<int>(b.add_material(material)))}});
  return b;
}

TEST(Blend, WithoutAlphaThereIsNoMesh) {
  GlbBuilder b = quad_of(
      {{"alphaMode", "BLEND"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0}}}}});
  EXPECT_THROW(load(b), SceneError);  // nothing is left
  b.add_node({{"mesh", b.add_quad({0, 0, 1}, {1, 0, 0}, {0, 1, 0})}});
  const SceneData scene = load(b);
  EXPECT_EQ(scene.meshes.size(), 1U);
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("1 primitives of alphaMode BLEND with alpha 0"),
            std::string::npos);
}

TEST(Unlit, EmitsItsColourAndReflectsNothing) {
  const SceneData scene = load(
      quad_of({{"pbrMetallicRoughness",
                {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}, {"baseColorTexture", {{"index", 0}}}}},
               {"extensions", {{"KHR_materials_unlit", Json::object()}}}}));
  const Material& m = scene.materials[0];
  EXPECT_EQ(m.emission, Rgb(0.1F, 0.2F, 0.3F));
  EXPECT_TRUE(m.emission_texture.used());
  EXPECT_EQ(m.base_color, Rgb(0, 0, 0));
  EXPECT_EQ(m.specular, 0.0F);
  EXPECT_TRUE(scene.warnings.empty());
}

TEST(SpecularGlossiness, IsADielectricOfThatReflectance) {
  SceneData scene = load(quad_of({{"extensions",
                                   {{"KHR_materials_pbrSpecularGlossiness",
                                     {{"diffuseFactor", {0.2, 0.4, 0.6, 0.5}},
                                      {"specularFactor", {0.5, 0.25, 1}},
                                      {"glossinessFactor", 0.5},
                                      {"specularGlossinessTexture", {{"index", 0}}}}}}}}));
  scene.textures[0]->decode();
  const SurfaceParams p = surface_params(scene.materials[0], scene.textures, {V2f(0), V2f(0)});
  EXPECT_EQ(p.base_color, Rgb(0.2F, 0.4F, 0.6F));
  EXPECT_EQ(p.metallic, 0.0F);
  EXPECT_NEAR(p.f0.x, 0.5, 1e-6);
  EXPECT_NEAR(p.f0.y, 0.25 * 0.21586, 1e-5);  // sRGB 128
  EXPECT_EQ(p.f0.z, 0.0F);
  EXPECT_NEAR(p.alpha, 0.8 * 0.8, 1e-6);  // the glossiness is 0.5 times 102 / 255
}

TEST(Variants, ChooseMaterialsByTheirName) {
  GlbBuilder b = quad_of({{"name", "plain"}});
  b.add_material({{"name", "shiny"}});
  b.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "dull"}},
                                                                {{"name", "bright"}}};
  b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_variants"]["mappings"] = {
      {{"material", 1}, {"variants", {1}}}};
  const TemporaryFolder folder;
  const auto file = folder.write("scene.glb", b.glb());
  const auto name = [&](const std::string& variant) {
    const SceneData scene = load_gltf(file, nullptr, {.variant = variant});
    return scene.materials[scene.meshes[0].material].name;
  };
  EXPECT_EQ(name(""), "plain");
  EXPECT_EQ(name("dull"), "plain");
  EXPECT_EQ(name("bright"), "shiny");
  try {
    name("matt");
    FAIL() << "not refused";
  } catch (const SceneError& e) {
    const std::string text = e.what();
    EXPECT_NE(text.find("\"matt\"; allowed: \"dull\", \"bright\""), std::string::npos) << text;
  }
}

TEST(Cameras, OrthographicOnesHaveTheHeightOfTheFile) {
  GlbBuilder b = quad_of(Json::object());
  b.json["cameras"] = {{{"type", "orthographic"},
                        {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 1}}}}};
  b.add_node({{"camera", 0}, {"name", "plan"}});
  const SceneData scene = load(b);
  ASSERT_EQ(scene.cameras.size(), 1U);
  EXPECT_EQ(scene.cameras[0].name, "plan");
  EXPECT_EQ(scene.cameras[0].projection, Projection::orthographic);
  EXPECT_EQ(scene.cameras[0].height, 6);
}

TEST(LightUnits, OfBlendersExporterAreSaidAndConverted) {
  for (const auto& [generator, warns] : {std::pair("Khronos glTF Blender I/O v4.5.32", true),
                                         {"Khronos glTF Blender I/O v3.3.14", false},
                                         {"another", false}}) {
    GlbBuilder b = quad_of(Json::object());
    b.json["asset"]["generator"] = generator;
    b.add_light({{"type", "point"}, {"intensity", 683}});
    const TemporaryFolder folder;
    const auto file = folder.write("scene.glb", b.glb());
    const auto read = [&](LightUnits units) {
      return load_gltf(file, nullptr, {.light_units = units});
    };
    EXPECT_EQ(read(LightUnits::file).lights[0].intensity, Rgb(683, 683, 683));
    EXPECT_EQ(read(LightUnits::file).warnings.size(), warns ? 1U : 0U) << generator;
    EXPECT_EQ(read(LightUnits::photometric).lights[0].intensity, Rgb(1, 1, 1));
    EXPECT_TRUE(read(LightUnits::radiometric).warnings.empty());
  }
}

TEST(Features, OfAFileAreListedWithTheirTreatment) {
  GlbBuilder b = mapped_quad(to_right);
  b.json["materials"][0]["occlusionTexture"] = {{"index", 0}};
  b.json["extensionsUsed"] = {"KHR_materials_unlit", "KHR_texture_basisu", "ACME_felt"};
  const TemporaryFolder folder;
  std::string all;
  for (const FeatureUse& f : features_of(folder.write("scene.glb", b.glb()))) {
    all += f.name + ": " + f.treatment + "\n";
  }
  EXPECT_EQ(all,
            "triangles, strips, fans: exact\nmetallic-roughness: exact\nnormal maps: exact\n"
            "occlusion maps: left out\ntextures: exact\nKHR_materials_unlit: exact\n"
            "KHR_texture_basisu: left out\nACME_felt: left out\n");
}

TEST(Features, RequiredButLeftOutAreRefusedWithARemedy) {
  GlbBuilder b = quad_of(Json::object());
  b.json["extensionsRequired"] = {"KHR_texture_basisu"};
  try {
    load(b);
    FAIL() << "not refused";
  } catch (const SceneError& e) {
    EXPECT_NE(std::string(e.what()).find("gltf-transform ktxdecompress"), std::string::npos)
        << e.what();
  }
}

TEST(Features, AreNamedAlsoWhereTheFileDoesNotListThem) {
  const Json glass{{"extensions", {{"KHR_materials_dispersion", {{"dispersion", 0.1}}}}}};
  const SceneData scene = load(quad_of(glass));
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_EQ(scene.warnings[0], "extension KHR_materials_dispersion is not supported and left out");
  const Json note{{"extras", glass}};
  EXPECT_TRUE(load(quad_of(note)).warnings.empty());
}

TEST(Features, AreOnThePage) {
  std::ifstream page(std::string(LACUNA_SOURCE_DIR) + "/docs/scenes.md");
  const std::string text(std::istreambuf_iterator<char>(page), {});
  EXPECT_NE(text.find(feature_table()), std::string::npos) << "./dev docs writes it anew";
}

/// The extensions that sources of renderer/gltf name, but for the table itself.
std::set<std::string> extensions_in_sources() {
  std::set<std::string> names;
  const std::regex name("\"((KHR|EXT|MSFT|LACUNA)_[A-Za-z_]+)\"");
  const std::filesystem::path folder = std::string(LACUNA_SOURCE_DIR) + "/renderer/gltf";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().filename() == "gltf_features.cpp") continue;
    std::ifstream source(entry.path());
    const std::string text(std::istreambuf_iterator<char>(source), {});
    for (std::sregex_iterator it(text.begin(), text.end(), name), end; it != end; ++it) {
      names.insert((*it)[1]);
    }
  }
  return names;
}

TEST(Features, AreThoseThatTheSourcesRead) {
  std::set<std::string> in_table;
  for (const gltf::Feature& f : gltf::all_features()) {
    const bool read = f.used_in == nullptr && f.treatment != gltf::Treatment::left_out;
    if (read) in_table.emplace(f.name);
  }
  // Marks what it makes, and is read as nothing else.
  in_table.erase("KHR_mesh_quantization");
  EXPECT_EQ(extensions_in_sources(), in_table);
}

}  // namespace
}  // namespace lacuna
