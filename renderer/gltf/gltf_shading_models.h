#pragma once

#include "renderer/gltf/gltf_textures.h"

namespace lacuna::gltf {

/// Reads what replaces metallic-roughness in a material that has been read: KHR_materials_unlit,
/// else KHR_materials_pbrSpecularGlossiness.
void read_shading_model(const GltfObject& material, TextureTable& textures, Material& out);

}  // namespace lacuna::gltf
