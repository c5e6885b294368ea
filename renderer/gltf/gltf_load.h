#pragma once

#include <filesystem>

#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// Reads a .gltf or .glb. Everything it names must lie in the file's own folder.
/// Throws SceneError.
SceneData load_gltf(const std::filesystem::path& file);

}  // namespace lacuna
