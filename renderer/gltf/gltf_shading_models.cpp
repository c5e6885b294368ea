#include "renderer/gltf/gltf_shading_models.h"

namespace lacuna::gltf {
namespace {

Rgb rgb_of(const double* a) {
  return {static_cast<float>(a[0]), static_cast<float>(a[1]), static_cast<float>(a[2])};
}

/// The colour itself reaches the eye: it is emitted, and nothing is reflected. What emits also
/// lights other surfaces.
void make_unlit(Material& out) {
  out.unlit = true;
  out.emission = out.base_color;
  out.emission_texture = out.base_color_texture;
  out.base_color = Rgb(0, 0, 0);
  if (!out.mask && !out.blend) out.base_color_texture = {};
  out.metallic = 0;
  out.specular = 0;
  out.transmission = 0;
  out.extensions = {};
  for (TextureRef* t :
       {&out.metallic_roughness_texture, &out.specular_texture, &out.specular_color_texture,
        &out.transmission_texture, &out.normal_texture}) {
    *t = {};
  }
}

/// A dielectric whose reflectance at normal incidence is the specular colour: with an ior of 0
/// (KHR_materials_ior) that is KHR_materials_specular's colour, and f90 is 1. The extension weights
/// the diffuse part with 1 - max(specular); Lacuna's layer with what its Schlick term lets through
/// at each angle.
void read_specular_glossiness(const GltfObject& from, TextureTable& textures, Material& out) {
  out.base_color = Rgb(1, 1, 1);
  out.alpha = 1;
  if (const auto c = from.numbers<4>("diffuseFactor", unit_interval)) {
    out.base_color = rgb_of(c->data());
    out.alpha = static_cast<float>((*c)[3]);
  }
  out.base_color_texture =
      textures.reference(from, "diffuseTexture", Texture::Encoding::srgb, true);
  out.metallic = 0;
  out.metallic_roughness_texture = {};
  out.ior = 0;
  out.specular = 1;
  out.specular_texture = {};
  out.specular_color = Rgb(1, 1, 1);
  if (const auto c = from.numbers<3>("specularFactor", unit_interval)) {
    out.specular_color = rgb_of(c->data());
  }
  const auto glossiness = static_cast<float>(from.number("glossinessFactor", 1, unit_interval));
  out.roughness = 1 - glossiness;
  out.specular_color_texture =
      textures.reference(from, "specularGlossinessTexture", Texture::Encoding::srgb, true);
  out.textured_glossiness = out.specular_color_texture.used() && glossiness > 0;
}

}  // namespace

void read_shading_model(const GltfObject& material, TextureTable& textures, Material& out) {
  if (material.extension("KHR_materials_unlit")) return make_unlit(out);
  if (const auto old = material.extension("KHR_materials_pbrSpecularGlossiness")) {
    read_specular_glossiness(*old, textures, out);
  }
}

}  // namespace lacuna::gltf
