#pragma once

#include <optional>
#include <string>

#include "renderer/gltf/gltf_object.h"
#include "renderer/gltf/scene_folder.h"

namespace lacuna::gltf {

/// The bytes of a data: URI, as base64; none for another kind of uri. Throws SceneError with
/// `place` for a data: URI of another media type, and for one that is no base64.
std::optional<Bytes> decode_data_uri(const GltfObject& place, const std::string& uri);

}  // namespace lacuna::gltf
