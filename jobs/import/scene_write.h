#pragma once

#include <filesystem>
#include <vector>

#include "jobs/import/imported_scene.h"

namespace lacuna {

/// Writes `scene` as FOLDER/scene.glb, its textures and its environment, and FOLDER/job.json, which
/// names them as the scenes root above the folder has them ("NAME/scene.glb"). A mesh of several
/// shapes is stored once. Returns the notes of the scene and those of the writing. Throws
/// SceneError if there is nothing to write, std::system_error, std::length_error.
std::vector<ImportNote> write_imported_scene(const ImportedScene& scene,
                                             const std::filesystem::path& folder);

}  // namespace lacuna
