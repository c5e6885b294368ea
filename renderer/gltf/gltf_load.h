#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/storage/input_file.h"
#include "renderer/geometry/scene_data.h"

namespace lacuna {

/// The time at which the animations of a file are evaluated.
struct SceneTime {
  std::optional<double> seconds = {};  ///< none: the static pose, without animations
  std::string animation = {};          ///< name of the only animation used; empty: all
};

/// Reads a .gltf or .glb. All files that it refers to must lie in its own folder.
/// Sets `inputs`, unless it is null, to all files that were read, as SceneFolder::inputs().
/// Throws SceneError, and InputUnreadable if the cause may be temporary.
SceneData load_gltf(const std::filesystem::path& file, std::vector<InputFile>* inputs = nullptr,
                    const SceneTime& time = {});

}  // namespace lacuna
