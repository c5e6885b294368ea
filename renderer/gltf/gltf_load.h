#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/storage/input_file.h"
#include "renderer/geometry/scene_data.h"
#include "renderer/settings/scene_settings.h"

namespace lacuna {

/// The choices of a job among what a file offers.
struct SceneChoice {
  /// The time at which the animations are evaluated, seconds; none: the static pose, without
  /// animations.
  std::optional<double> seconds = {};
  std::string animation = {};  ///< name of the only animation used; empty: all
  std::string variant = {};    ///< name of the material variant; empty: none
  LightUnits light_units = LightUnits::file;
};

/// Reads a .gltf or .glb. All files that it refers to must lie in its own folder.
/// Sets `inputs`, unless it is null, to all files that were read, as SceneFolder::inputs().
/// Throws SceneError, and InputUnreadable if the cause may be temporary.
SceneData load_gltf(const std::filesystem::path& file, std::vector<InputFile>* inputs = nullptr,
                    const SceneChoice& choice = {});

}  // namespace lacuna
