#include "renderer/materials/gltf_material.h"

#include "renderer/materials/specular.h"

namespace lacuna {
namespace {

/// Values of textures at a point.
struct Texels {
  Textures textures;
  const std::array<V2f, 2>& uv;

  /// White without a texture.
  Rgba operator()(const TextureRef& ref) const {
    return ref.used() ? texture_at(ref, textures, uv) : Rgba{};
  }
};

Rgb at_most_1(const Rgb& c) {
  return {std::min(c.x, 1.0F), std::min(c.y, 1.0F), std::min(c.z, 1.0F)};
}

void set_anisotropy(const Anisotropy& a, const Texels& texel, SurfaceParams& p) {
  float strength = a.strength;
  V2f direction(1, 0);
  if (a.texture.used()) {
    const Rgba t = texel(a.texture);
    strength *= t.rgb.z;
    const V2f d(2 * t.rgb.x - 1, 2 * t.rgb.y - 1);
    if (d.length2() > 0) direction = d / d.length();
  }
  if (!(strength > 0)) return;
  p.alpha_along = p.alpha + (1 - p.alpha) * strength * strength;
  const float c = std::cos(a.rotation), s = std::sin(a.rotation);
  p.direction = {c * direction.x - s * direction.y, s * direction.x + c * direction.y};
}

void set_film(const Iridescence& i, const Texels& texel, SurfaceParams& p) {
  p.film.strength = i.factor * texel(i.texture).rgb.x;
  p.film.ior = i.ior;
  const float t = texel(i.thickness_texture).rgb.y;
  p.film.thickness = i.thinnest + (i.thickest - i.thinnest) * t;
}

/// Each only if the material has it.
void set_extensions(const Material& material, const Texels& texel, SurfaceParams& p) {
  const MaterialExtensions& e = material.extensions;
  p.solid = e.volume.solid;
  p.medium = material.medium();
  if (const auto& d = e.diffuse_transmission; d.factor > 0) {
    p.diffuse_transmission = d.factor * texel(d.texture).a;
    p.diffuse_transmission_color = d.color * texel(d.color_texture).rgb;
  }
  if (const auto& c = e.coat; c.factor > 0) {
    p.coat = c.factor * texel(c.texture).rgb.x;
    const float roughness = c.roughness * texel(c.roughness_texture).rgb.y;
    p.coat_alpha = roughness * roughness;
  }
  if (const auto& s = e.sheen; !is_black(s.color)) {
    p.sheen_color = s.color * texel(s.color_texture).rgb;
    const float roughness = s.roughness * texel(s.roughness_texture).a;
    p.sheen_alpha = roughness * roughness;
  }
  if (e.anisotropy.strength > 0) set_anisotropy(e.anisotropy, texel, p);
  if (e.iridescence.factor > 0) set_film(e.iridescence, texel, p);
}

}  // namespace

bool is_lambertian(const Material& m) {
  const MaterialExtensions& e = m.extensions;
  return !m.lacuna && m.metallic == 0 && m.specular == 0 && m.transmission == 0 &&
         e.diffuse_transmission.factor == 0 && e.coat.factor == 0 && is_black(e.sheen.color);
}

SurfaceParams surface_params(const Material& material, Textures textures,
                             const std::array<V2f, 2>& uv) {
  const Texels texel{textures, uv};
  SurfaceParams p;
  p.base_color = base_color(material, textures, uv);
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
  p.f0 = p.f90 * at_most_1(tinted);
  set_extensions(material, texel, p);
  return p;
}

}  // namespace lacuna
