#pragma once

#include <filesystem>
#include <string_view>

#include "jobs/import/imported_scene.h"

namespace lacuna {

/// Reads a scene of Mitsuba 0.6, 2 or 3 (XML), with the files that it includes and names, which lie
/// in its folder. Throws SceneError with file, line and element for what is wrong or not read;
/// with MissingFiles::refuse also for files that do not exist, of which it names the first.
ImportedScene read_mitsuba(const std::filesystem::path& file, MissingFiles missing);

/// The same of a text that names no files.
ImportedScene read_mitsuba_text(std::string_view xml);

}  // namespace lacuna
