#pragma once

// The library links tinygltf as Debian compiles it, so no source defines its implementation.
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include <span>

#include "renderer/gltf/gltf_guard.h"
#include "renderer/gltf/hasher.h"
#include "renderer/gltf/scene_folder.h"

namespace lacuna::gltf {

/// Lets tinygltf parse a file that check_structure() has passed. Buffers are filled; images keep
/// their encoded bytes only if they came as a data: URI. External buffers are read through `folder`
/// and enter `content`. Throws SceneError.
tinygltf::Model parse_model(std::span<const std::uint8_t> file, const Framing& framing,
                            const GltfObject& root, SceneFolder& folder, Hasher& content);

/// Throws SceneError for a data: URI of another kind than tinygltf decodes.
void refuse_data_uri(const GltfObject& place, const std::string& uri);

}  // namespace lacuna::gltf
