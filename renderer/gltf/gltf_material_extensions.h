#pragma once

#include "renderer/gltf/gltf_textures.h"

namespace lacuna::gltf {

/// Reads the extensions of MaterialExtensions from a material. Throws SceneError.
void read_material_extensions(const GltfObject& material, TextureTable& textures,
                              MaterialExtensions& out);

}  // namespace lacuna::gltf
