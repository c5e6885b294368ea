#include "renderer/gltf/gltf_material_extensions.h"

#include <cmath>
#include <string>

namespace lacuna::gltf {
namespace {

constexpr Limits from_one{1, non_negative.max};

/// The members of one extension of a material.
struct Reader {
  const GltfObject& from;
  TextureTable& textures;

  float number(std::string_view key, float fallback, const Limits& allowed = unit_interval) const {
    return static_cast<float>(from.number(key, fallback, allowed));
  }
  Rgb colour(std::string_view key, const Rgb& fallback) const {
    const auto c = from.numbers<3>(key, unit_interval);
    if (!c) return fallback;
    return {static_cast<float>((*c)[0]), static_cast<float>((*c)[1]), static_cast<float>((*c)[2])};
  }
  TextureRef texture(std::string_view key, Texture::Encoding encoding, bool needed) const {
    return textures.reference(from, key, encoding, needed);
  }
};

void read_volume(const Reader& in, Volume& out) {
  out.solid = in.number("thicknessFactor", 0, non_negative) > 0;
  // Of the preview of rasterizers only: paths know how far they go.
  in.texture("thicknessTexture", Texture::Encoding::linear, false);
  const Rgb colour = in.colour("attenuationColor", {1, 1, 1});
  if (!in.from.has("attenuationDistance")) return;
  constexpr double smallest = std::numeric_limits<float>::min();
  const double distance =
      in.from.number("attenuationDistance", {smallest, std::numeric_limits<float>::max()});
  // Beer and Lambert: colour = exp(-extinction distance). Black absorbs all, in any distance.
  const auto extinction = [&](float c) {
    const double e = -std::log(std::max(double(c), smallest)) / distance;
    return static_cast<float>(std::min(e, double(std::numeric_limits<float>::max())));
  };
  out.inside.extinction = {extinction(colour.x), extinction(colour.y), extinction(colour.z)};
}

void read_diffuse_transmission(const Reader& in, DiffuseTransmission& out) {
  out.factor = in.number("diffuseTransmissionFactor", 0);
  const bool used = out.factor > 0;
  out.texture = in.texture("diffuseTransmissionTexture", Texture::Encoding::linear, used);
  out.color = in.colour("diffuseTransmissionColorFactor", {1, 1, 1});
  out.color_texture = in.texture("diffuseTransmissionColorTexture", Texture::Encoding::srgb,
                                 used && !is_black(out.color));
}

void read_coat(const Reader& in, ClearCoat& out) {
  out.factor = in.number("clearcoatFactor", 0);
  out.texture = in.texture("clearcoatTexture", Texture::Encoding::linear, out.factor > 0);
  out.roughness = in.number("clearcoatRoughnessFactor", 0);
  out.roughness_texture = in.texture("clearcoatRoughnessTexture", Texture::Encoding::linear,
                                     out.factor > 0 && out.roughness > 0);
  if (const auto map = in.from.object("clearcoatNormalTexture")) {
    out.normal_scale = static_cast<float>(map->number("scale", 1, any_float));
    out.normal_texture = in.texture("clearcoatNormalTexture", Texture::Encoding::linear,
                                    out.factor > 0 && out.normal_scale != 0);
  }
}

void read_sheen(const Reader& in, SheenLayer& out) {
  out.color = in.colour("sheenColorFactor", {0, 0, 0});
  const bool used = !is_black(out.color);
  out.color_texture = in.texture("sheenColorTexture", Texture::Encoding::srgb, used);
  out.roughness = in.number("sheenRoughnessFactor", 0);
  out.roughness_texture =
      in.texture("sheenRoughnessTexture", Texture::Encoding::linear, used && out.roughness > 0);
}

void read_anisotropy(const Reader& in, Anisotropy& out) {
  out.strength = in.number("anisotropyStrength", 0);
  out.rotation = in.number("anisotropyRotation", 0, any_float);
  out.texture = in.texture("anisotropyTexture", Texture::Encoding::linear, out.strength > 0);
}

void read_iridescence(const Reader& in, Iridescence& out) {
  out.factor = in.number("iridescenceFactor", 0);
  const bool used = out.factor > 0;
  out.texture = in.texture("iridescenceTexture", Texture::Encoding::linear, used);
  out.ior = in.number("iridescenceIor", out.ior, from_one);
  out.thinnest = in.number("iridescenceThicknessMinimum", out.thinnest, non_negative);
  out.thickest = in.number("iridescenceThicknessMaximum", out.thickest, non_negative);
  out.thickness_texture =
      in.texture("iridescenceThicknessTexture", Texture::Encoding::linear, used);
}

/// Files that were converted from Mitsuba's scenes when transmission still meant a solid here note
/// the plugin, whose dielectric is one.
bool noted_as_solid(const GltfObject& material) {
  return !material.extension("KHR_materials_volume") &&
         material.extra("source").starts_with("smooth dielectric");
}

}  // namespace

void read_material_extensions(const GltfObject& material, TextureTable& textures,
                              MaterialExtensions& out) {
  const auto read = [&](const char* name, auto reader, auto& into) {
    const auto extension = material.extension(name);
    if (extension) reader(Reader{*extension, textures}, into);
  };
  read("KHR_materials_volume", read_volume, out.volume);
  if (noted_as_solid(material)) out.volume.solid = true;
  read("KHR_materials_diffuse_transmission", read_diffuse_transmission, out.diffuse_transmission);
  read("KHR_materials_clearcoat", read_coat, out.coat);
  read("KHR_materials_sheen", read_sheen, out.sheen);
  read("KHR_materials_anisotropy", read_anisotropy, out.anisotropy);
  read("KHR_materials_iridescence", read_iridescence, out.iridescence);
}

}  // namespace lacuna::gltf
