#pragma once

#include <cstdint>
#include <string_view>

#include "renderer/gltf/gltf_object.h"

namespace lacuna::gltf {

inline constexpr std::string_view meshopt_extension = "EXT_meshopt_compression";

/// Largest size of all decoded data of a file: a few compressed bytes can claim any size.
inline constexpr std::uint64_t max_decoded_bytes = (std::uint64_t{1} << 31) - 1;

/// Whether a buffer has no bytes in the file, and is filled by decoding bufferViews
/// (EXT_meshopt_compression).
bool is_fallback(const GltfObject& buffer);

/// Part of check_structure(): refuses compressed data whose sizes do not fit those of the buffers
/// and accessors, decoded sizes that are too large for the compressed bytes, and large accessors
/// without any data.
void check_compression(const GltfObject& root);

}  // namespace lacuna::gltf
