#pragma once

#include "renderer/gltf/gltf_model.h"

namespace lacuna::gltf {

/// See check_compression() and decode_compressed(), for EXT_meshopt_compression.
void check_meshopt(const GltfObject& root);
void decode_meshopt(const GltfObject& root, file::Model& model);

}  // namespace lacuna::gltf
