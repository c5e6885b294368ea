#include <gtest/gtest.h>

#include <numbers>

#include "renderer/geometry/scene_data.h"
#include "tests/renderer/gltf/expect_near.h"
#include "tests/renderer/gltf/glb_builder.h"
#include "tests/renderer/images/test_images.h"

namespace lacuna {
namespace {

using test::GlbBuilder;
using test::load;

/// A quad with uvs and the given material, and two textures to choose from.
GlbBuilder quad_with(const Json& material) {
  GlbBuilder b;
  b.add_texture(test::encode8(1, 1, 3, {255, 128, 0}));
  b.add_texture(test::encode8(1, 1, 3, {0, 128, 255}), {{"wrapS", 33071}, {"wrapT", 33648}});
  b.add_node({{"mesh", b.add_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                  static_cast<int>(b.add_material(material)))}});
  return b;
}

TEST(MaterialsLoading, DefaultsAreThoseOfGltf) {
  const auto scene = load(quad_with(Json::object()));
  ASSERT_EQ(scene.materials.size(), 2U);
  for (const Material& m : scene.materials) {
    EXPECT_EQ(m.base_color, Rgb(1));
    EXPECT_EQ(m.alpha, 1.0F);
    EXPECT_EQ(m.metallic, 1.0F);
    EXPECT_EQ(m.roughness, 1.0F);
    EXPECT_FALSE(m.emits());
    EXPECT_EQ(m.ior, 1.5F);
    EXPECT_EQ(m.specular, 1.0F);
    EXPECT_EQ(m.transmission, 0.0F);
    EXPECT_FALSE(m.mask);
    EXPECT_FALSE(m.double_sided);
    EXPECT_FALSE(m.base_color_texture.used());
  }
  EXPECT_TRUE(scene.textures.empty()) << "a texture that no material uses is not kept";
}

TEST(MaterialsLoading, APrimitiveWithoutMaterialTakesTheLast) {
  GlbBuilder b = quad_with({{"name", "other"}});
  b.json["meshes"][0]["primitives"][0].erase("material");
  const auto scene = load(b);
  EXPECT_EQ(scene.meshes.at(0).material, 1U);
  EXPECT_EQ(scene.materials.at(1).name, "default");
}

TEST(MaterialsLoading, EveryFieldArrives) {
  const auto scene = load(quad_with(
      {{"name", "all"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 0.3, 0.4}},
         {"metallicFactor", 0.5},
         {"roughnessFactor", 0.6}}},
       {"emissiveFactor", {1, 0.5, 0.25}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.7},
       {"doubleSided", true},
       {"extensions",
        {{"KHR_materials_emissive_strength", {{"emissiveStrength", 10000000000}}},
         {"KHR_materials_ior", {{"ior", 0}}},
         {"KHR_materials_specular", {{"specularFactor", 0.8}, {"specularColorFactor", {2, 3, 4}}}},
         {"KHR_materials_transmission", {{"transmissionFactor", 0.9}}},
         {"KHR_materials_volume",
          {{"thicknessFactor", 0.1},
           {"attenuationDistance", 0.5},
           {"attenuationColor", {1, 0.5, 0}}}},
         {"KHR_materials_diffuse_transmission",
          {{"diffuseTransmissionFactor", 0.1},
           {"diffuseTransmissionColorFactor", {0.2, 0.3, 0.4}}}},
         {"KHR_materials_clearcoat",
          {{"clearcoatFactor", 0.11}, {"clearcoatRoughnessFactor", 0.12}}},
         {"KHR_materials_sheen",
          {{"sheenColorFactor", {0.5, 0.6, 0.7}}, {"sheenRoughnessFactor", 0.13}}},
         {"KHR_materials_anisotropy", {{"anisotropyStrength", 0.14}, {"anisotropyRotation", -1.5}}},
         {"KHR_materials_iridescence",
          {{"iridescenceFactor", 0.15},
           {"iridescenceIor", 1.6},
           {"iridescenceThicknessMinimum", 50},
           {"iridescenceThicknessMaximum", 350}}}}}}));
  const Material& m = scene.materials.at(0);
  EXPECT_EQ(m.name, "all");
  EXPECT_EQ(m.base_color, Rgb(0.1F, 0.2F, 0.3F));
  EXPECT_EQ(m.alpha, 0.4F);
  EXPECT_EQ(m.metallic, 0.5F);
  EXPECT_EQ(m.roughness, 0.6F);
  EXPECT_EQ(m.emission, Rgb(1e10F, 0.5e10F, 0.25e10F)) << "an integer beyond 32 bits";
  EXPECT_TRUE(m.mask);
  EXPECT_EQ(m.alpha_cutoff, 0.7F);
  EXPECT_TRUE(m.double_sided);
  EXPECT_EQ(m.ior, 0.0F);
  EXPECT_EQ(m.specular, 0.8F);
  EXPECT_EQ(m.specular_color, Rgb(2, 3, 4));
  EXPECT_EQ(m.transmission, 0.9F);
  const MaterialExtensions& e = m.extensions;
  EXPECT_TRUE(e.volume.solid);
  EXPECT_EQ(e.volume.inside.extinction.x, 0.0F);
  EXPECT_NEAR(e.volume.inside.extinction.y, std::log(2) / 0.5, 1e-6);
  EXPECT_GT(e.volume.inside.extinction.z, 100) << "black absorbs all";
  EXPECT_EQ(m.medium(), &e.volume.inside);
  EXPECT_EQ(e.diffuse_transmission.factor, 0.1F);
  EXPECT_EQ(e.diffuse_transmission.color, Rgb(0.2F, 0.3F, 0.4F));
  EXPECT_EQ(e.coat.factor, 0.11F);
  EXPECT_EQ(e.coat.roughness, 0.12F);
  EXPECT_EQ(e.sheen.color, Rgb(0.5F, 0.6F, 0.7F));
  EXPECT_EQ(e.sheen.roughness, 0.13F);
  EXPECT_EQ(e.anisotropy.strength, 0.14F);
  EXPECT_EQ(e.anisotropy.rotation, -1.5F);
  EXPECT_EQ(e.iridescence.factor, 0.15F);
  EXPECT_EQ(e.iridescence.ior, 1.6F);
  EXPECT_EQ(e.iridescence.thinnest, 50.0F);
  EXPECT_EQ(e.iridescence.thickest, 350.0F);
}

TEST(MaterialsLoading, ExtensionsAreOffWithoutTheirFactor) {
  Json extensions;
  for (const char* name : {"volume", "diffuse_transmission", "clearcoat", "sheen", "anisotropy",
                           "iridescence", "transmission"}) {
    extensions[std::string("KHR_materials_") + name] = Json::object();
  }
  const auto scene = load(quad_with({{"name", "default"}, {"extensions", extensions}}));
  EXPECT_TRUE(scene.warnings.empty());
  EXPECT_EQ(scene.materials.at(0), scene.materials.at(1));
}

TEST(MaterialsLoading, ASolidByANote) {
  const auto is_solid = [](const Json& extras) {
    const auto scene = load(quad_with({{"extras", extras}}));
    return scene.materials.at(0).extensions.volume.solid;
  };
  EXPECT_TRUE(is_solid({{"source", "smooth dielectric ior 1.5"}}));
  EXPECT_FALSE(is_solid({{"source", "diffuse"}}));
  EXPECT_FALSE(is_solid({{"source", 1}}));
  EXPECT_FALSE(is_solid("smooth dielectric"));
  EXPECT_FALSE(is_solid(nullptr));
}

TEST(MaterialsLoading, AMediumNeedsASolidThatLightEnters) {
  const auto absorbs = [](double transmission, double thickness) {
    const auto scene =
        load(quad_with({{"extensions",
                         {{"KHR_materials_transmission", {{"transmissionFactor", transmission}}},
                          {"KHR_materials_volume",
                           {{"thicknessFactor", thickness},
                            {"attenuationDistance", 1},
                            {"attenuationColor", {0.5, 0.5, 0.5}}}}}}}));
    return scene.materials.at(0).medium() != nullptr;
  };
  EXPECT_TRUE(absorbs(1, 1));
  EXPECT_FALSE(absorbs(0, 1));
  EXPECT_FALSE(absorbs(1, 0)) << "a thin wall";
}

TEST(MaterialsLoading, OneImageReadInTwoWaysBecomesTwoTextures) {
  const Json zero{{"index", 0}};
  const auto scene = load(quad_with(
      {{"pbrMetallicRoughness", {{"baseColorTexture", zero}, {"metallicRoughnessTexture", zero}}},
       {"emissiveTexture", zero},
       {"emissiveFactor", {1, 1, 1}},
       {"extensions",
        {{"KHR_materials_specular",
          {{"specularTexture", zero}, {"specularColorTexture", {{"index", 1}}}}}}}}));
  const Material& m = scene.materials.at(0);
  ASSERT_EQ(scene.textures.size(), 3U);
  EXPECT_EQ(m.base_color_texture.texture, m.emission_texture.texture);
  EXPECT_EQ(m.metallic_roughness_texture.texture, m.specular_texture.texture);
  EXPECT_NE(m.base_color_texture.texture, m.metallic_roughness_texture.texture);
  for (const auto& texture : scene.textures) texture->decode();
  const auto green = [&scene](const TextureRef& ref) {
    return scene.textures[static_cast<std::size_t>(ref.texture)]->lookup({0, 0}).rgb.y;
  };
  EXPECT_NEAR(green(m.base_color_texture), 0.21586, 1e-5);  // sRGB 128
  EXPECT_NEAR(green(m.metallic_roughness_texture), 128.0 / 255, 1e-6);
}

TEST(MaterialsLoading, ATextureBehindAFactorOfZeroIsNotKept) {
  const Json zero{{"index", 0}};
  const auto scene = load(quad_with(
      {{"emissiveTexture", zero},
       {"extensions", {{"KHR_materials_transmission", {{"transmissionTexture", zero}}}}}}));
  EXPECT_TRUE(scene.textures.empty());
}

TEST(MaterialsLoading, TextureTransformAndItsTexCoord) {
  const Json info{
      {"index", 0},
      {"texCoord", 0},
      {"extensions",
       {{"KHR_texture_transform",
         {{"offset", {0.25, 0.5}}, {"rotation", 0.5}, {"scale", {2, 3}}, {"texCoord", 1}}}}}};
  const auto scene = load(quad_with({{"pbrMetallicRoughness", {{"baseColorTexture", info}}}}));
  const TextureRef& ref = scene.materials.at(0).base_color_texture;
  EXPECT_EQ(ref.uv_set, 1);
  EXPECT_EQ(ref.offset, V2f(0.25F, 0.5F));
  EXPECT_EQ(ref.scale, V2f(2, 3));
  EXPECT_EQ(ref.rotation, 0.5F);
  // The quad has TEXCOORD_0 only.
  EXPECT_TRUE(scene.meshes.at(0).uvs[1].empty());
  ASSERT_EQ(scene.warnings.size(), 1U);
  EXPECT_NE(scene.warnings[0].find("TEXCOORD_1"), std::string::npos);
}

TEST(MaterialsLoading, WhatIsLeftOutIsSaid) {
  const auto scene = load(quad_with({{"occlusionTexture", {{"index", 0}}},
                                     {"extensions", {{"ACME_materials_felt", Json::object()}}}}));
  EXPECT_TRUE(scene.textures.empty());
  ASSERT_EQ(scene.warnings.size(), 2U);
  EXPECT_NE(scene.warnings[0].find("occlusion maps"), std::string::npos);
  EXPECT_NE(scene.warnings[1].find("ACME_materials_felt"), std::string::npos);
}

TEST(TextureTransform, ScalesThenTurnsThenShifts) {
  TextureRef ref;
  ref.offset = {10, 20};
  ref.scale = {2, 3};
  expect_near(ref.transform({1, 1}), {12, 23});
  ref.rotation = std::numbers::pi_v<float> / 6;
  // (2, 3) turned by 30 degrees with v down: (2 cos + 3 sin, 3 cos - 2 sin).
  expect_near(ref.transform({1, 1}), {10 + 1.7320508F + 1.5F, 20 + 2.5980762F - 1});
}

/// The first example of the extension: offset (0, 1), a quarter turn and scale 0.5 show the lower
/// left quadrant, turned clockwise: the quad's upper left corner shows the image's lower left one.
TEST(TextureTransform, TheExtensionsOwnExample) {
  TextureRef ref;
  ref.offset = {0, 1};
  ref.scale = {0.5F, 0.5F};
  ref.rotation = std::numbers::pi_v<float> / 2;
  expect_near(ref.transform({0, 0}), {0, 1});
  expect_near(ref.transform({1, 0}), {0, 0.5F});
  expect_near(ref.transform({1, 1}), {0.5F, 0.5F});
  expect_near(ref.transform({0, 1}), {0.5F, 1});
}

}  // namespace
}  // namespace lacuna
