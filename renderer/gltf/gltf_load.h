#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/storage/input_file.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// A moment of the animations of a file.
struct SceneTime {
  std::optional<double> seconds = {};  ///< none: the static pose, without animations
  std::string animation = {};          ///< the only one that counts; empty: all of them
};

/// Reads a .gltf or .glb. Everything it names must lie in the file's own folder.
/// Sets `inputs`, unless it is null, to all files that were read, as SceneFolder::inputs().
/// Throws SceneError, and InputUnreadable where the reason may pass.
SceneData load_gltf(const std::filesystem::path& file, std::vector<InputFile>* inputs = nullptr,
                    const SceneTime& time = {});

}  // namespace lacuna
