#pragma once

#include <filesystem>

#include "jobs/import/imported_scene.h"

namespace lacuna {

/// Reads a scene of pbrt-v3 or pbrt-v4 (also .pbrt.gz): which of the two follows from its first
/// statement that only one of them has. Files that it names lie within its folder. Throws
/// SceneError with file and line for what is not valid, and, unless `missing` is skip, for the
/// first of the files that do not exist; InputUnreadable if a file cannot be read now.
ImportedScene read_pbrt(const std::filesystem::path& file, MissingFiles missing);

}  // namespace lacuna
