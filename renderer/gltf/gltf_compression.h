#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "renderer/gltf/gltf_model.h"

namespace lacuna::gltf {

inline constexpr std::string_view meshopt_extension = "EXT_meshopt_compression";
inline constexpr std::string_view draco_extension = "KHR_draco_mesh_compression";

/// All that a file may decode, its bytes and, for Draco, its vertices and triangles: a few bytes
/// can claim any size.
inline constexpr std::uint64_t max_decoded_bytes = (std::uint64_t{1} << 31) - 1;
inline constexpr std::uint64_t max_decoded_elements = std::uint64_t{1} << 27;

/// Whether a buffer has no bytes in the file, and is filled by decoding bufferViews
/// (EXT_meshopt_compression).
bool is_fallback(const GltfObject& buffer);

/// The Draco data of a primitive if some of its accessors have no others; none: they are not
/// needed.
std::optional<GltfObject> needed_draco(const GltfObject& primitive,
                                       const std::vector<GltfObject>& accessors);

/// Part of check_structure(): refuses compressed data whose sizes do not fit those of the buffers and
/// accessors, what claims too much for the bytes it has, and large accessors without any data.
void check_compression(const GltfObject& root);

/// Fills fallback buffers, and adds buffers with what Draco held. Throws SceneError.
void decode_compressed(const GltfObject& root, file::Model& model);

}  // namespace lacuna::gltf
