#pragma once

#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// alphaMode MASK of one mesh: which points of its triangles are opaque.
class AlphaMask {
 public:
  /// Whether the mask can reject a hit: the material has a mask, and its alpha is textured or below
  /// the cutoff.
  static bool needed(const SceneData& scene, const Mesh& mesh) {
    const Material& m = scene.materials[mesh.material];
    return m.mask && (m.base_color_texture.used() || m.alpha < m.alpha_cutoff);
  }

  /// Keeps pointers into `scene`; decode the texture before the first call of opaque().
  AlphaMask(const SceneData& scene, const Mesh& mesh)
      : mesh_(&mesh),
        material_(&scene.materials[mesh.material]),
        texture_(
            material_->base_color_texture.used()
                ? scene.textures[static_cast<std::size_t>(material_->base_color_texture.texture)]
                      .get()
                : nullptr),
        uvs_(&mesh.uvs[static_cast<std::size_t>(material_->base_color_texture.uv_set)]) {}

  /// Whether the point at barycentric (u, v), as in Hit, is opaque.
  bool opaque(std::uint32_t triangle, float u, float v) const {
    float alpha = material_->alpha;
    if (texture_ != nullptr) {
      V2f uv(0, 0);
      if (!uvs_->empty()) {
        const auto& t = mesh_->triangles[triangle];
        uv = (1 - u - v) * (*uvs_)[t[0]] + u * (*uvs_)[t[1]] + v * (*uvs_)[t[2]];
      }
      alpha *= texture_->lookup(material_->base_color_texture.transform(uv)).a;
    }
    return alpha >= material_->alpha_cutoff;
  }

 private:
  const Mesh* mesh_;
  const Material* material_;
  const Texture* texture_;
  const std::vector<V2f>* uvs_;
};

}  // namespace lacuna
