#pragma once

#include <vector>

#include "renderer/gltf/gltf_textures.h"

namespace lacuna::gltf {

/// All materials of the file and glTF's default material behind them. Throws SceneError on a value
/// outside of what glTF or its extensions allow.
std::vector<Material> read_materials(const GltfObject& root, TextureTable& textures,
                                     Warnings& warnings);

}  // namespace lacuna::gltf
