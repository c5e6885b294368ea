#pragma once

#include <vector>

#include "renderer/gltf/gltf_textures.h"

namespace lacuna::gltf {

/// LACUNA_materials of all `materials` of the file (docs/LACUNA_materials.schema.json), whose other
/// members have been read. Throws SceneError, also for a material that is part of itself, directly
/// or not, and for parts of parts beyond a depth of 8 or 256 of them.
void read_lacuna_materials(const GltfObject& root, TextureTable& textures,
                           std::vector<Material>& materials);

}  // namespace lacuna::gltf
