#include "renderer/gltf/gltf_materials.h"

#include "renderer/gltf/gltf_lacuna_materials.h"
#include "renderer/gltf/gltf_material_extensions.h"
#include "renderer/gltf/gltf_shading_models.h"

namespace lacuna::gltf {
namespace {

using Encoding = Texture::Encoding;

Rgb to_rgb(const std::array<double, 3>& a) {
  return {static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2])};
}

float read(const GltfObject& from, std::string_view key, float fallback, Limits allowed) {
  return static_cast<float>(from.number(key, fallback, allowed));
}

void read_metallic_roughness(const GltfObject& material, TextureTable& textures, Material& out) {
  const auto pbr = material.object("pbrMetallicRoughness");
  if (!pbr || material.extension("KHR_materials_pbrSpecularGlossiness")) return;
  if (const auto c = pbr->numbers<4>("baseColorFactor", unit_interval)) {
    out.base_color = to_rgb({(*c)[0], (*c)[1], (*c)[2]});
    out.alpha = static_cast<float>((*c)[3]);
  }
  out.metallic = read(*pbr, "metallicFactor", out.metallic, unit_interval);
  out.roughness = read(*pbr, "roughnessFactor", out.roughness, unit_interval);
  out.base_color_texture = textures.reference(*pbr, "baseColorTexture", Encoding::srgb, true);
  out.metallic_roughness_texture = textures.reference(
      *pbr, "metallicRoughnessTexture", Encoding::linear, out.metallic > 0 || out.roughness > 0);
}

void read_emission(const GltfObject& material, TextureTable& textures, Material& out) {
  if (const auto factor = material.light_colour("emissiveFactor")) out.emission = to_rgb(*factor);
  if (const auto strength = material.extension("KHR_materials_emissive_strength")) {
    out.emission *= read(*strength, "emissiveStrength", 1, non_negative);
    if (!is_finite(out.emission)) {
      strength->fail("emissiveFactor times emissiveStrength is more than a float can hold");
    }
  }
  out.emission_texture =
      textures.reference(material, "emissiveTexture", Encoding::srgb, out.emits());
}

void read_specular(const GltfObject& material, TextureTable& textures, Material& out) {
  if (const auto ior = material.extension("KHR_materials_ior")) {
    out.ior = read(*ior, "ior", out.ior, non_negative);
    if (out.ior != 0 && out.ior < 1 - hair) ior->refuse("ior", "0, or a number, at least 1");
    if (out.ior != 0) out.ior = read(*ior, "ior", out.ior, {1, non_negative.max});
  }
  if (const auto specular = material.extension("KHR_materials_specular")) {
    out.specular = read(*specular, "specularFactor", out.specular, unit_interval);
    if (const auto color = specular->numbers<3>("specularColorFactor", non_negative)) {
      out.specular_color = to_rgb(*color);
    }
    const bool seen = out.specular > 0;
    out.specular_texture = textures.reference(*specular, "specularTexture", Encoding::linear, seen);
    out.specular_color_texture = textures.reference(
        *specular, "specularColorTexture", Encoding::srgb, seen && !is_black(out.specular_color));
  }
  if (const auto transmission = material.extension("KHR_materials_transmission")) {
    out.transmission = read(*transmission, "transmissionFactor", out.transmission, unit_interval);
    out.transmission_texture = textures.reference(*transmission, "transmissionTexture",
                                                  Encoding::linear, out.transmission > 0);
  }
}

void read_normal_map(const GltfObject& material, TextureTable& textures, Material& out) {
  const auto map = material.object("normalTexture");
  if (!map) return;
  out.normal_scale = read(*map, "scale", out.normal_scale, any_float);
  out.normal_texture =
      textures.reference(material, "normalTexture", Encoding::linear, out.normal_scale != 0);
}

/// Without a map of its own the coat is not bent, even if its base is.
void set_coat_normal(Material& out) {
  ClearCoat& coat = out.extensions.coat;
  const bool same = coat.normal_texture == out.normal_texture &&
                    (!coat.normal_texture.used() || coat.normal_scale == out.normal_scale);
  coat.own_normal = coat.factor > 0 && !same;
  if (same) coat.normal_texture = {};
}

void read_alpha(const GltfObject& material, Material& out) {
  const std::string mode = material.string("alphaMode", "OPAQUE");
  if (mode != "OPAQUE" && mode != "MASK" && mode != "BLEND") {
    material.refuse("alphaMode", "\"OPAQUE\", \"MASK\" or \"BLEND\"");
  }
  out.mask = mode == "MASK";
  out.blend = mode == "BLEND";
  out.alpha_cutoff = read(material, "alphaCutoff", out.alpha_cutoff, non_negative);
  out.double_sided = material.boolean("doubleSided", out.double_sided);
}

void warn_of_unread_extensions(const GltfObject& material, Warnings& warnings) {
  if (material.has("occlusionTexture")) {
    warnings.once("occlusion maps are left out: occlusion is what is being computed");
  }
  const auto extensions = material.object("extensions");
  if (!extensions) return;
  for (const std::string& name : extensions->keys()) {
    if (!extension_supported(name)) warnings.once(unsupported_extension(name));
  }
}

}  // namespace

std::vector<Material> read_materials(const GltfObject& root, TextureTable& textures,
                                     Warnings& warnings) {
  std::vector<Material> materials;
  for (const GltfObject& material : root.objects("materials")) {
    Material out;
    out.name = material.string("name", material.label());
    read_metallic_roughness(material, textures, out);
    read_emission(material, textures, out);
    read_specular(material, textures, out);
    read_material_extensions(material, textures, out.extensions);
    read_alpha(material, out);
    read_normal_map(material, textures, out);
    set_coat_normal(out);
    read_shading_model(material, textures, out);
    warn_of_unread_extensions(material, warnings);
    materials.push_back(std::move(out));
  }
  read_lacuna_materials(root, textures, materials);
  materials.emplace_back().name = "default";
  return materials;
}

}  // namespace lacuna::gltf
