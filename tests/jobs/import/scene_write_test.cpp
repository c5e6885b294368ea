#include "jobs/import/scene_write.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "jobs/import/shape_meshes.h"
#include "jobs/spec/job_json.h"
#include "renderer/emitters/environment.h"
#include "renderer/gltf/gltf_load.h"
#include "renderer/images/exr_write.h"
#include "renderer/images/image_read.h"
#include "renderer/images/png_write.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

/// A square of a material with a camera.
ImportedScene scene_of(ImportedMaterial material) {
  ImportedScene scene;
  ImportedShape shape;
  shape.mesh = std::make_shared<const ImportedMesh>(rectangle_mesh());
  shape.material = std::make_shared<const ImportedMaterial>(std::move(material));
  scene.shapes.push_back(shape);
  scene.cameras.emplace_back().name = "eye";
  return scene;
}

SceneData loaded(const ImportedScene& scene, const TemporaryFolder& folder,
                 std::vector<ImportNote>* notes = nullptr) {
  const auto found = write_imported_scene(scene, folder / "s");
  if (notes != nullptr) *notes = found;
  SceneData data = load_gltf(folder / "s/scene.glb");
  for (const auto& texture : data.textures) texture->decode();
  return data;
}

/// 2 x 2 texels: red, green / blue, white, of these codes.
std::shared_ptr<const ImportedTexture> corners(const TemporaryFolder& folder, std::uint8_t code) {
  const std::vector<std::uint8_t> rgb{code, 0, 0, 0, code, 0, 0, 0, code, code, code, code};
  ImportedTexture t;
  t.file = folder.write("corners.png", encode_png(2, 2, rgb));
  return std::make_shared<const ImportedTexture>(t);
}

Rgb at(const SceneData& scene, const TextureRef& ref, const V2f& uv) {
  return scene.textures.at(static_cast<std::size_t>(ref.texture))->lookup(ref.transform(uv)).rgb;
}

TEST(SceneWrite, PicturesAreCopiedAndStandUpright) {
  const TemporaryFolder folder;
  ImportedMaterial m;
  m.diffuse = {Rgb(1), corners(folder, 255)};
  const SceneData scene = loaded(scene_of(m), folder);
  EXPECT_EQ(content_of(folder / "s/textures/corners.png"), content_of(folder / "corners.png"));
  const Mesh& square = scene.meshes[0];
  for (std::size_t i = 0; i < 4; ++i) {
    // Upper left of the square, whose u and v grow with x and y, is red.
    const bool left = square.positions[i].x<0, top = square.positions[i].y> 0;
    const V2f uv = square.uvs[0][i] * .5F + V2f(.25F, .25F);
    const Rgb expected =
        top ? (left ? Rgb(1, 0, 0) : Rgb(0, 1, 0)) : (left ? Rgb(0, 0, 1) : Rgb(1, 1, 1));
    const Rgb found = at(scene, scene.materials[square.material].base_color_texture, uv);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-5) << i;
  }
}

/// uv of the picture = scale * uv + offset, v upwards in both.
TEST(SceneWrite, PlacingOfAPictureIsThatOfTheDescription) {
  const TemporaryFolder folder;
  ImportedTexture t = *corners(folder, 255);
  t.scale = {2, .5};
  t.offset = {.25, .125};
  ImportedMaterial m;
  m.diffuse = {Rgb(1), std::make_shared<const ImportedTexture>(t)};
  const SceneData scene = loaded(scene_of(m), folder);
  const TextureRef& ref = scene.materials[scene.meshes[0].material].base_color_texture;
  for (const V2f& uv : {V2f(.2F, .3F), V2f(.7F, .9F), V2f(.4F, .1F)}) {
    const V2f picture = {2 * uv.x + .25F, .5F * uv.y + .125F};
    const Rgb expected = scene.textures[0]->lookup({picture.x, 1 - picture.y}).rgb;
    const Rgb found = at(scene, ref, {uv.x, 1 - uv.y});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-4);
  }
}

TEST(SceneWrite, LinearPicturesAreEncodedAgain) {
  const TemporaryFolder folder;
  ImportedTexture t = *corners(folder, 128);
  t.srgb = false;
  t.gamma = 2;
  ImportedMaterial m;
  m.diffuse = {Rgb(1), std::make_shared<const ImportedTexture>(t)};
  std::vector<ImportNote> notes;
  const SceneData scene = loaded(scene_of(m), folder, &notes);
  const double linear = std::pow(128 / 255.0, 2);
  EXPECT_NEAR(double(scene.textures[0]->texel({0, 0}).x), linear, .003);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].how, "rounded to 8 bits of sRGB");
}

TEST(SceneWrite, OpacityBecomesTheAlphaOfTheColour) {
  const TemporaryFolder folder;
  ImportedTexture opacity = *corners(folder, 204);  // .8
  opacity.srgb = false;
  opacity.channel = 0;
  ImportedMaterial m;
  m.diffuse = {{.5F, .25F, 1}, nullptr};
  m.opacity = {Rgb(.5F), std::make_shared<const ImportedTexture>(opacity)};
  const SceneData scene = loaded(scene_of(m), folder);
  const Material& found = scene.materials[scene.meshes[0].material];
  EXPECT_TRUE(found.blend);
  EXPECT_FLOAT_EQ(found.alpha, .5F);
  EXPECT_EQ(found.base_color, Rgb(.5F, .25F, 1));
  const Texture& texture = *scene.textures[0];
  EXPECT_NEAR(texture.lookup({.25F, .25F}).a, .8F, .002);  // red
  EXPECT_NEAR(texture.lookup({.75F, .25F}).a, 0, 1e-6);    // green
  EXPECT_NEAR(texture.texel({1, 0}).x, 1, 1e-6);           // white where nothing is
}

TEST(SceneWrite, CheckerboardIsBaked) {
  const TemporaryFolder folder;
  ImportedTexture t;
  t.even = {1, 0, 0};
  t.odd = {0, 0, 1};
  ImportedMaterial m;
  m.diffuse = {Rgb(1), std::make_shared<const ImportedTexture>(t)};
  const SceneData scene = loaded(scene_of(m), folder);
  const TextureRef& ref = scene.materials[scene.meshes[0].material].base_color_texture;
  EXPECT_EQ(at(scene, ref, {.25F, .75F}), Rgb(1, 0, 0));  // u, v upwards: .25, .25
  EXPECT_EQ(at(scene, ref, {.75F, .75F}), Rgb(0, 0, 1));
}

TEST(SceneWrite, LightTexturesAboveOneKeepTheirRange) {
  const TemporaryFolder folder;
  write_exr(folder / "light.exr", {2, 1, {{"", {"R", "G", "B"}, {8, 4, 2, 1, 0, 0}}}, {}, {}});
  ImportedTexture t;
  t.file = folder / "light.exr";
  ImportedScene imported = scene_of({});
  imported.shapes[0].radiance = {Rgb(3), std::make_shared<const ImportedTexture>(t)};
  const SceneData scene = loaded(imported, folder);
  const Material& m = scene.materials[scene.meshes[0].material];
  const Rgb radiance = m.emission * scene.textures[0]->texel({0, 0});
  EXPECT_NEAR(radiance.x, 24, .1);
  EXPECT_NEAR(radiance.y, 12, .1);
}

TEST(SceneWrite, FlippedShapesShowTheirOtherSide) {
  const TemporaryFolder folder;
  ImportedScene imported = scene_of({});
  imported.shapes[0].flipped = true;
  const SceneData scene = loaded(imported, folder);
  const Mesh& m = scene.meshes[0];
  const auto& t = m.triangles[0];
  const V3f n =
      (m.positions[t[1]] - m.positions[t[0]]).cross(m.positions[t[2]] - m.positions[t[0]]);
  EXPECT_LT(n.z, 0);
  EXPECT_LT(m.normals[0].z, 0);
}

/// A picture of which each direction's colour is the direction.
std::filesystem::path picture_of_directions(const TemporaryFolder& folder) {
  constexpr int width = 256, height = 128;
  ExrPicture picture{width, height, {{"", {"R", "G", "B"}, {}}}, {}, {}};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      // In the picture's own coordinates: centre +x, left +y, up +z.
      const double azimuth = -2 * std::numbers::pi * ((x + .5) / width - .5),
                   polar = std::numbers::pi * (y + .5) / height;
      for (const double v : {std::sin(polar) * std::cos(azimuth),
                             std::sin(polar) * std::sin(azimuth), std::cos(polar)}) {
        picture.layers[0].values.push_back(1 + v);
      }
    }
  }
  write_exr(folder / "directions.exr", picture);
  return folder / "directions.exr";
}

/// Both by a job's `rotation` and resampled, the environment shows what the description says.
TEST(SceneWrite, EnvironmentsKeepTheirOrientation) {
  M44d upright(0, 0, -1, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1), turned = upright,
                                                                  tilted = upright;
  M44d about_y, about_x;
  about_y.setAxisAngle(V3d(0, 1, 0), .7);
  about_x.setAxisAngle(V3d(1, 0, 0), .4);
  turned = upright * about_y;
  tilted = turned * about_x;
  for (const M44d& to_world : {upright, turned, tilted}) {
    const TemporaryFolder folder;
    ImportedScene imported = scene_of({});
    imported.environment = ImportedEnvironment{};
    imported.environment->file = picture_of_directions(folder);
    imported.environment->scale = Rgb(2);
    imported.environment->to_world = to_world;
    write_imported_scene(imported, folder / "s");
    const JobSpec job = parse_job(content_of(folder / "s/job.json"));
    ASSERT_TRUE(job.environment);
    const FloatImage image = read_float_image(folder / job.environment->file);
    const Environment environment(
        image.width, image.height, image.rgb, static_cast<float>(job.environment->scale),
        static_cast<float>(job.environment->rotation * std::numbers::pi / 180));
    for (const V3d& p : {V3d(1, 0, 0), V3d(.6, .8, 0), V3d(.48, -.6, .64), V3d(-.6, 0, .8)}) {
      V3d w;
      to_world.multDirMatrix(p, w);
      const Rgb found = environment.radiance(V3f(w.normalized()));
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], 2 * (1 + p[c]), .02) << p << to_world;
    }
  }
}

TEST(SceneWrite, LensesAndCropsGoIntoTheJob) {
  const TemporaryFolder folder;
  ImportedScene imported = scene_of({});
  imported.cameras[0].aperture = .25;
  imported.cameras[0].focus = 4;
  imported.picture = {{200, 100}, std::array<int, 2>{50, 20}, {100, 60}, 7};
  write_imported_scene(imported, folder / "s");
  const JobSpec job = parse_job(content_of(folder / "s/job.json"));
  const auto& camera = job.camera.object;
  ASSERT_TRUE(camera);
  EXPECT_EQ(camera->aperture, .25);
  EXPECT_EQ(camera->focus, 4);
  EXPECT_EQ(camera->target, (std::array<double, 3>{0, 0, -4}));
  EXPECT_EQ(job.resolution, (std::array<int, 2>{100, 60}));
  ASSERT_TRUE(job.crop);
  EXPECT_EQ(job.crop->of, (std::array<int, 2>{200, 100}));
  EXPECT_EQ(job.crop->from, (std::array<int, 2>{50, 20}));
}

TEST(SceneWrite, MetallicAndRoughnessAreOnePicture) {
  const TemporaryFolder folder;
  const auto grey = [&](const std::string& name, std::uint8_t code) {
    ImportedTexture t;
    t.file = folder.write(name, encode_png(1, 1, std::vector<std::uint8_t>(3, code)));
    t.srgb = false;
    return std::make_shared<const ImportedTexture>(t);
  };
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::standard;
  m.roughness_texture = grey("r.png", 51);
  m.metallic_texture = grey("m.png", 204);
  m.metallic = 1;
  for (const bool both : {true, false}) {
    if (!both) m.metallic_texture = nullptr;
    const SceneData scene = loaded(scene_of(m), folder);
    const Rgb found = at(scene, scene.materials[0].metallic_roughness_texture, V2f(.5F, .5F));
    EXPECT_NEAR(found.y, .2, 1e-3);
    EXPECT_NEAR(found.z, both ? .8 : 1, 1e-3);
  }
}

TEST(SceneWrite, RoundingBeyondOneIsNoNote) {
  const TemporaryFolder folder;
  ImportedMaterial m;
  m.type = ImportedMaterial::Type::diffuse_transmission;
  m.transmittance.value = Rgb(1.000001F, .5F, 1);
  std::vector<ImportNote> notes;
  EXPECT_EQ(loaded(scene_of(m), folder, &notes).materials[0].extensions.diffuse_transmission.color,
            Rgb(1, .5F, 1));
  EXPECT_TRUE(notes.empty());
  m.transmittance.value.x = 1.1F;
  loaded(scene_of(m), folder, &notes);
  EXPECT_EQ(notes.size(), 1U);
}

TEST(SceneWrite, NormalsWithoutALengthAreThoseOfTheTriangles) {
  const TemporaryFolder folder;
  ImportedScene scene = scene_of({});
  ImportedMesh mesh;
  mesh.name = "tilted";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}};
  mesh.normals = {{0, 2, 0}, {0, 0, 0}, V3f(std::nanf(""))};
  mesh.triangles = {{0, 1, 2}};
  scene.shapes[0].mesh = std::make_shared<const ImportedMesh>(mesh);
  for (const bool flipped : {false, true}) {
    scene.shapes[0].flipped = flipped;
    const SceneData data = loaded(scene, folder);
    ASSERT_EQ(data.meshes[0].normals.size(), 3U);
    for (const V3f& n : data.meshes[0].normals) EXPECT_EQ(n, V3f(0, flipped ? -1 : 1, 0));
  }
  mesh.triangles.clear();
  scene.shapes.emplace_back(scene.shapes[0]).mesh = std::make_shared<const ImportedMesh>(mesh);
  std::vector<ImportNote> notes;
  loaded(scene, folder, &notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_EQ(notes[0].name, "tilted");
}

}  // namespace
}  // namespace lacuna
