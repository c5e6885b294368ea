#include "renderer/materials/gltf_material.h"

#include "renderer/materials/specular.h"

namespace lacuna {

SurfaceParams surface_params(const Material& material, Textures textures,
                             const std::array<V2f, 2>& uv) {
  const auto texel = [&](const TextureRef& ref) {
    return ref.used() ? texture_at(ref, textures, uv) : Rgba{};
  };
  SurfaceParams p;
  p.base_color = material.base_color * texel(material.base_color_texture).rgb;
  p.metallic = material.metallic;
  float roughness = material.roughness;
  if (material.metallic_roughness_texture.used()) {
    const Rgba t = texel(material.metallic_roughness_texture);
    roughness *= t.rgb.y;
    p.metallic *= t.rgb.z;
  }
  if (material.textured_glossiness) {
    roughness = 1 - (1 - roughness) * texel(material.specular_color_texture).a;
  }
  p.alpha = roughness * roughness;
  p.transmission = material.transmission * texel(material.transmission_texture).rgb.x;

  // KHR_materials_specular. An ior of 0 means a reflectance of 1; transmitted light is still
  // refracted.
  if (material.ior != 0) p.ior = material.ior;
  const float f0 = material.ior == 0 ? 1.0F : normal_reflectance(material.ior);
  p.f90 = material.specular * texel(material.specular_texture).a;
  const Rgb tinted = f0 * material.specular_color * texel(material.specular_color_texture).rgb;
  p.f0 = p.f90 * Rgb(std::min(tinted.x, 1.0F), std::min(tinted.y, 1.0F), std::min(tinted.z, 1.0F));
  return p;
}

}  // namespace lacuna
