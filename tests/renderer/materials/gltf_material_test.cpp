// glTF materials become surface parameters as the specification and its extensions say.

#include "renderer/materials/gltf_material.h"

#include <gtest/gtest.h>

namespace lacuna {
namespace {

constexpr std::array<V2f, 2> uv{V2f(0.5F, 0.5F), V2f(0.5F, 0.5F)};

using Bytes = std::vector<std::uint8_t>;

void append_u32(Bytes& out, std::uint32_t x) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<std::uint8_t>(x >> shift));
}

/// Length, type, data and CRC (PNG specification, sec. 5.3 and annex D).
void append_chunk(Bytes& out, const char* type, const Bytes& data) {
  append_u32(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type, type + 4);
  out.insert(out.end(), data.begin(), data.end());
  std::uint32_t crc = ~0U;
  for (std::size_t i = start; i < out.size(); ++i) {
    crc ^= out[i];
    for (int k = 0; k < 8; ++k) crc = (crc >> 1) ^ ((crc & 1U) != 0 ? 0xEDB88320U : 0U);
  }
  append_u32(out, ~crc);
}

using Pixel = std::array<std::uint8_t, 4>;

/// A PNG of one row of pixels, in a stored block of zlib.
Bytes png_row(const std::vector<Pixel>& pixels) {
  const auto width = static_cast<std::uint8_t>(pixels.size());
  Bytes png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  append_chunk(png, "IHDR", {0, 0, 0, width, 0, 0, 0, 1, 8, 6, 0, 0, 0});
  Bytes row{0};
  for (const Pixel& p : pixels) row.insert(row.end(), p.begin(), p.end());
  const auto length = static_cast<std::uint8_t>(row.size());
  Bytes zlib{0x78, 0x01, 1, length, 0, static_cast<std::uint8_t>(~length), 0xFF};
  std::uint32_t a = 1, b = 0;
  for (const std::uint8_t byte : row) {
    zlib.push_back(byte);
    a += byte;
    b += a;
  }
  append_u32(zlib, b << 16 | a);
  append_chunk(png, "IDAT", zlib);
  append_chunk(png, "IEND", {});
  return png;
}

class GltfTextures : public testing::Test {
 protected:
  TextureRef add(const std::vector<Pixel>& pixels, Texture::Encoding encoding) {
    textures_.push_back(std::make_unique<Texture>("test pixels", png_row(pixels), encoding,
                                                  Texture::Wrap::repeat, Texture::Wrap::repeat));
    textures_.back()->decode();
    TextureRef ref;
    ref.texture = static_cast<int>(textures_.size()) - 1;
    return ref;
  }
  std::vector<std::unique_ptr<Texture>> textures_;
};

TEST(GltfMaterial, DefaultsAreThoseOfTheSpecification) {
  const SurfaceParams p = surface_params(Material{}, {}, uv);
  EXPECT_EQ(p.base_color, Rgb(1, 1, 1));
  EXPECT_EQ(p.metallic, 1);
  EXPECT_EQ(p.alpha, 1);
  EXPECT_NEAR(p.f0.x, 0.04, 1e-7);
  EXPECT_EQ(p.f90, 1);
  EXPECT_EQ(p.transmission, 0);
  EXPECT_EQ(p.ior, 1.5F);
  // One truth about what an unspecified dielectric reflects.
  EXPECT_NEAR(SurfaceParams{}.f0.x, p.f0.x, 1e-7);
  EXPECT_EQ(SurfaceParams{}.ior, p.ior);
}

TEST(GltfMaterial, RoughnessIsSquared) {
  Material m;
  m.roughness = 0.3F;
  EXPECT_FLOAT_EQ(surface_params(m, {}, uv).alpha, 0.09F);
}

TEST(GltfMaterial, IorSetsTheReflectance) {
  Material m;
  for (const float ior : {1.0F, 1.33F, 2.4F, 15.0F}) {
    m.ior = ior;
    const SurfaceParams p = surface_params(m, {}, uv);
    EXPECT_FLOAT_EQ(p.f0.y, (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1)));
    EXPECT_EQ(p.ior, ior);
  }
}

TEST(GltfMaterial, Ior0ReflectsEverything) {
  Material m;
  m.ior = 0;
  const SurfaceParams p = surface_params(m, {}, uv);
  EXPECT_EQ(p.f0, Rgb(1, 1, 1));
  EXPECT_GE(p.ior, 1);
  m.specular_color = Rgb(0.5F, 0.25F, 1);
  EXPECT_EQ(surface_params(m, {}, uv).f0, Rgb(0.5F, 0.25F, 1));
}

TEST(GltfMaterial, SpecularDimsAndTints) {
  Material m;
  m.specular = 0.5F;
  m.specular_color = Rgb(1, 2, 100);
  const SurfaceParams p = surface_params(m, {}, uv);
  EXPECT_NEAR(p.f0.x, 0.02, 1e-7);
  EXPECT_NEAR(p.f0.y, 0.04, 1e-7);
  EXPECT_EQ(p.f0.z, 0.5F);  // min(0.04 * 100, 1) before the factor
  EXPECT_EQ(p.f90, 0.5F);
}

/// specularFactor = 0 turns the dielectric into Lambert's law itself.
TEST(GltfMaterial, WithoutSpecularItIsLambert) {
  Material m;
  m.metallic = 0;
  m.specular = 0;
  m.base_color = Rgb(0.2F, 0.4F, 0.6F);
  const V3f n(0, 0, 1);
  const Bsdf bsdf(surface_params(m, {}, uv), n, n);
  const V3f wo = V3f(0.3F, 0.1F, 0.5F).normalized(), wi = V3f(-0.7F, 0.1F, 0.4F).normalized();
  EXPECT_EQ(bsdf.eval(wo, wi, Transport::radiance), m.base_color * (wi.z * inv_pi));
  EXPECT_EQ(bsdf.pdf(wo, wi).value, wi.z * inv_pi);
  EXPECT_EQ(bsdf.albedo(), m.base_color);
}

TEST(GltfMaterial, AlbedoOfMetalAndGlassIsTheirBaseColor) {
  const V3f n(0, 0, 1);
  Material m;
  m.base_color = Rgb(0.2F, 0.4F, 0.6F);
  EXPECT_EQ(Bsdf(surface_params(m, {}, uv), n, n).albedo(), m.base_color);
  m.metallic = 0;
  m.transmission = 1;
  EXPECT_EQ(Bsdf(surface_params(m, {}, uv), n, n).albedo(), m.base_color);
  m.transmission = 0;
  EXPECT_NEAR(Bsdf(surface_params(m, {}, uv), n, n).albedo().x, 0.04 + 0.96 * 0.2, 1e-6);
}

TEST_F(GltfTextures, MultiplyTheirFactorsFromTheRightChannels) {
  Material m;
  m.base_color = Rgb(0.5F, 1, 1);
  m.base_color_texture = add({{{255, 188, 0, 10}}}, Texture::Encoding::srgb);
  m.roughness = 0.5F;
  m.metallic = 0.5F;
  m.metallic_roughness_texture = add({{{7, 51, 204, 9}}}, Texture::Encoding::linear);
  m.transmission = 0.5F;
  m.transmission_texture = add({{{102, 7, 8, 9}}}, Texture::Encoding::linear);
  m.specular = 0.5F;
  m.specular_texture = add({{{7, 8, 9, 153}}}, Texture::Encoding::linear);
  m.specular_color_texture = add({{{255, 188, 0, 10}}}, Texture::Encoding::srgb);
  m.emission = Rgb(10, 10, 10);
  m.emission_texture = add({{{255, 188, 0, 10}}}, Texture::Encoding::srgb);

  const SurfaceParams p = surface_params(m, textures_, uv);
  constexpr float srgb_188 = 0.5029F;  // ((188/255 + 0.055) / 1.055)^2.4
  EXPECT_NEAR(p.base_color.x, 0.5, 1e-6);
  EXPECT_NEAR(p.base_color.y, srgb_188, 1e-4);
  EXPECT_EQ(p.base_color.z, 0);
  EXPECT_NEAR(p.alpha, 0.1 * 0.1, 1e-6);
  EXPECT_NEAR(p.metallic, 0.4, 1e-6);
  EXPECT_NEAR(p.transmission, 0.2, 1e-6);
  EXPECT_NEAR(p.f90, 0.3, 1e-6);
  EXPECT_NEAR(p.f0.x, 0.3 * 0.04, 1e-6);
  EXPECT_NEAR(p.f0.y, 0.3 * 0.04 * srgb_188, 1e-6);
  EXPECT_EQ(p.f0.z, 0);
  const Rgb e = emission(m, textures_, uv);
  EXPECT_NEAR(e.x, 10, 1e-5);
  EXPECT_NEAR(e.y, 10 * srgb_188, 1e-3);
  EXPECT_EQ(e.z, 0);
}

/// The set of coordinates and KHR_texture_transform belong to the reference, not to the material.
TEST_F(GltfTextures, UseTheirOwnCoordinates) {
  const std::vector<Pixel> red_green{{{255, 0, 0, 255}}, {{0, 255, 0, 255}}};
  Material m;
  m.base_color_texture = add(red_green, Texture::Encoding::linear);
  m.base_color_texture.uv_set = 1;
  m.emission = Rgb(1, 1, 1);
  m.emission_texture = m.base_color_texture;
  m.emission_texture.offset = V2f(0.5F, 0);
  // Centres of the pixels.
  const std::array<V2f, 2> sets{V2f(0.25F, 0.5F), V2f(0.75F, 0.5F)};
  EXPECT_EQ(surface_params(m, textures_, sets).base_color, Rgb(0, 1, 0));
  EXPECT_EQ(emission(m, textures_, sets), Rgb(1, 0, 0));
  m.base_color_texture.uv_set = 0;
  EXPECT_EQ(surface_params(m, textures_, sets).base_color, Rgb(1, 0, 0));
}

}  // namespace
}  // namespace lacuna
