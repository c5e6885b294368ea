#pragma once

#include <cstdint>
#include <span>

#include "renderer/gltf/gltf_object.h"

namespace lacuna::gltf {

/// The parts of a .gltf or .glb file, validated before they are parsed.
struct Framing {
  bool binary = false;  ///< a GLB
  std::span<const std::uint8_t> json;
  std::uint64_t bin_bytes = 0;  ///< length of the BIN chunk; 0: none
  std::uint64_t bin_begin = 0;  ///< where it begins in the file
};

/// Splits a file into its chunks. A file with the magic bytes of GLB is a GLB, any other is JSON.
/// Throws SceneError if lengths in the header do not match the file, if the version is not 2, or if
/// a chunk has the wrong type.
Framing check_framing(std::span<const std::uint8_t> file);

/// Parses the JSON, at most 64 levels deep (tinygltf recurses). Throws SceneError.
Json parse_json(std::span<const std::uint8_t> text);

/// Validates what tinygltf does not: types, ranges and indices of buffers, bufferViews, accessors,
/// images, textures, samplers, meshes, nodes and scenes; that each bufferView lies inside its
/// buffer and each accessor inside its bufferView; that required extensions are supported.
/// Materials, cameras and lights are validated where they are read. Throws SceneError.
void check_structure(const GltfObject& root, const Framing& framing);

/// The names that may stand in extensionsRequired.
bool extension_supported(std::string_view name);
/// The warning about any other extension.
std::string unsupported_extension(std::string_view name);

}  // namespace lacuna::gltf
