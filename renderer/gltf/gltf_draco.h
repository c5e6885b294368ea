#pragma once

#include <string_view>
#include <vector>

#include "renderer/gltf/gltf_model.h"

namespace lacuna::gltf {

inline constexpr std::string_view draco_extension = "KHR_draco_mesh_compression";

/// Whether a primitive's data have to be decoded: it is compressed, and some accessor of it has no
/// data of its own.
bool is_draco(const GltfObject& primitive, const std::vector<GltfObject>& accessors);

/// Part of check_compression(): KHR_draco_mesh_compression. Returns the bytes that all compressed
/// primitives decode to.
std::uint64_t check_draco(const GltfObject& root);

/// Whether any primitive is_draco().
bool has_draco(const GltfObject& root);

/// Gives such primitives accessors with data. Throws SceneError.
void decode_draco(const GltfObject& root, file::Model& model);

}  // namespace lacuna::gltf
