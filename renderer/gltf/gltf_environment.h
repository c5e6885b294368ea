#pragma once

#include <optional>

#include "renderer/gltf/gltf_textures.h"

namespace lacuna::gltf {

/// The light of EXT_lights_image_based that the file's scene names; none if it names none. Of its
/// mipmaps only the largest is used: it holds what the smaller ones, and the coefficients of the
/// irradiance, are computed from. Throws SceneError.
std::optional<EnvironmentCube> read_environment(const GltfObject& root, TextureTable& textures);

}  // namespace lacuna::gltf
