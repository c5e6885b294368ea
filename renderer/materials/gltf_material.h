#pragma once

#include <memory>
#include <span>

#include "renderer/geometry/scene_data.h"
#include "renderer/materials/bsdf.h"

namespace lacuna {

using Textures = std::span<const std::unique_ptr<Texture>>;

/// The value of a used texture reference at `uv` (TEXCOORD_0 and _1). The texture must be decoded.
inline Rgba texture_at(const TextureRef& ref, Textures textures, const std::array<V2f, 2>& uv) {
  return textures[static_cast<std::size_t>(ref.texture)]->lookup(
      ref.transform(uv[static_cast<std::size_t>(ref.uv_set)]));
}

/// The base colour at texture coordinates `uv` (TEXCOORD_0 and _1).
inline Rgb base_color(const Material& material, Textures textures, const std::array<V2f, 2>& uv) {
  const TextureRef& texture = material.base_color_texture;
  return texture.used() ? material.base_color * texture_at(texture, textures, uv).rgb
                        : material.base_color;
}
/// Whether the surface is Lambertian, with the albedo base_color(), whatever its textures hold.
bool is_lambertian(const Material& material);

/// The surface parameters at texture coordinates `uv` (TEXCOORD_0 and _1). The textures that
/// `material` uses must be decoded. KHR_materials_ior and _specular determine f0 and f90; a surface
/// with both 0 is Lambertian.
SurfaceParams surface_params(const Material& material, Textures textures,
                             const std::array<V2f, 2>& uv);

/// Prefetches the texels that surface_params() reads.
inline void prefetch_textures(const Material& material, Textures textures,
                              const std::array<V2f, 2>& uv) {
  material.for_each_scattering_texture([&](const TextureRef& ref) {
    textures[static_cast<std::size_t>(ref.texture)]->prefetch(
        ref.transform(uv[static_cast<std::size_t>(ref.uv_set)]));
  });
}

/// Emitted radiance, equal in all directions of the emitting side or sides.
inline Rgb emission(const Material& material, Textures textures, const std::array<V2f, 2>& uv) {
  if (!material.emission_texture.used()) return material.emission;
  return material.emission * texture_at(material.emission_texture, textures, uv).rgb;
}

}  // namespace lacuna
