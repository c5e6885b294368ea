#pragma once

#include <algorithm>

#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// What a mesh of alphaMode MASK or BLEND covers: the probability with which its points are hit.
class AlphaMask {
 public:
  /// Whether a point can be hit with a probability below 1: the alpha is textured, varies between
  /// vertices, or is below what hides all.
  static bool needed(const SceneData& scene, const Mesh& mesh) {
    const Material& m = scene.materials[mesh.material];
    if (!m.mask && !m.blend) return false;
    return m.base_color_texture.used() || !mesh.colors.empty() ||
           m.alpha < (m.mask ? m.alpha_cutoff : 1.0F);
  }

  /// Keeps pointers into `scene`; decode the texture before the first call of coverage().
  AlphaMask(const SceneData& scene, const Mesh& mesh)
      : mesh_(&mesh),
        material_(&scene.materials[mesh.material]),
        texture_(
            material_->base_color_texture.used()
                ? scene.textures[static_cast<std::size_t>(material_->base_color_texture.texture)]
                      .get()
                : nullptr),
        uvs_(&mesh.uvs[static_cast<std::size_t>(material_->base_color_texture.uv_set)]) {}

  /// In [0, 1], at barycentric (u, v), as in Hit: with MASK 0 or 1, with BLEND the alpha.
  float coverage(std::uint32_t triangle, const V2f& at) const {
    float alpha = material_->alpha;
    if (texture_ != nullptr) {
      const V2f uv = uvs_->empty() ? V2f(0, 0) : mesh_->mix(*uvs_, triangle, at);
      alpha *= texture_->lookup(material_->base_color_texture.transform(uv)).a;
    }
    if (!mesh_->colors.empty()) alpha *= mesh_->mix(mesh_->colors, triangle, at).w;
    if (material_->mask) return alpha >= material_->alpha_cutoff ? 1.0F : 0.0F;
    return std::clamp(alpha, 0.0F, 1.0F);
  }

 private:
  const Mesh* mesh_;
  const Material* material_;
  const Texture* texture_;
  const std::vector<V2f>* uvs_;
};

/// Decides an event of that probability by the hash of `bits`: by the same bits always alike, by
/// others independently.
template <std::size_t n>
bool decide_by_bits(float probability, const std::array<std::uint32_t, n>& bits) {
  if (probability >= 1) return true;
  if (!(probability > 0)) return false;
  // Each word is mixed in by a multiplication and a shift (as in wyhash and the finalizer of
  // SplitMix64).
  std::uint64_t h = 0x9E3779B97F4A7C15;
  for (const std::uint32_t word : bits) {
    h = (h ^ word) * 0xD6E8FEB86659FD93;
    h ^= h >> 32;
  }
  h = (h ^ h >> 29) * 0xBF58476D1CE4E5B9;
  return static_cast<float>(h >> 40) * 0x1p-24F < probability;
}

}  // namespace lacuna
