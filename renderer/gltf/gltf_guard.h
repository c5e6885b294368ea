#pragma once

#include <cstdint>
#include <span>

#include "renderer/gltf/gltf_object.h"

namespace lacuna::gltf {

/// The parts of a .gltf or .glb file, checked before anyone else parses them.
struct Framing {
  bool binary = false;  ///< a GLB
  std::span<const std::uint8_t> json;
  std::uint64_t bin_bytes = 0;  ///< length of the BIN chunk; 0: none
};

/// Splits a file into its chunks. A GLB is told by its magic. Throws SceneError on a header that
/// lies about lengths, on a version other than 2 and on wrong chunk types.
Framing check_framing(std::span<const std::uint8_t> file);

/// Parses the JSON, at most 64 levels deep (tinygltf recurses). Throws SceneError.
Json parse_json(std::span<const std::uint8_t> text);

/// Checks everything that tinygltf takes on trust: types, ranges and indices of buffers,
/// bufferViews, accessors, images, textures, samplers, meshes, nodes and scenes; offsets and
/// lengths against what holds them; required extensions by name. Materials, cameras and lights are
/// checked by their readers. Throws SceneError.
void check_structure(const GltfObject& root, const Framing& framing);

/// The names that may stand in extensionsRequired.
bool extension_supported(std::string_view name);
/// The warning about any other extension.
std::string unsupported_extension(std::string_view name);

}  // namespace lacuna::gltf
