#pragma once

#include "renderer/gltf/gltf_model.h"

namespace lacuna::gltf {

/// Part of check_compression(): EXT_meshopt_compression.
void check_meshopt(const GltfObject& root);

/// Fills the fallback buffers. Throws SceneError.
void decode_meshopt(const GltfObject& root, file::Model& model);

}  // namespace lacuna::gltf
