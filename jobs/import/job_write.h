#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "jobs/import/environment_write.h"
#include "jobs/import/imported_scene.h"

namespace lacuna {

/// Writes FOLDER/job.json: the scene beside it, the first camera (by name; as an object where glTF
/// cannot say it: a lens, a panorama), resolution and crop, `path` with the file's depth, the
/// environment. Throws std::system_error.
void write_job_of(const ImportedScene& scene, const std::optional<WrittenEnvironment>& environment,
                  const std::filesystem::path& folder, std::vector<ImportNote>& notes);

}  // namespace lacuna
