#pragma once

#include "renderer/gltf/gltf_model.h"

namespace lacuna::gltf {

/// See check_compression() and decode_compressed(), for KHR_draco_mesh_compression.
void check_draco(const GltfObject& root);
void decode_draco(const GltfObject& root, file::Model& model);

}  // namespace lacuna::gltf
