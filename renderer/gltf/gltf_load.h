#pragma once

#include <filesystem>
#include <vector>

#include "base/storage/input_file.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// Reads a .gltf or .glb. Everything it names must lie in the file's own folder.
/// Sets `inputs`, unless it is null, to all files that were read, as SceneFolder::inputs().
/// Throws SceneError, and InputUnreadable where the reason may pass.
SceneData load_gltf(const std::filesystem::path& file, std::vector<InputFile>* inputs = nullptr);

}  // namespace lacuna
