#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/import/imported_scene.h"

namespace lacuna {

/// Keys of a job's `environment`.
struct WrittenEnvironment {
  std::string file;  ///< in the folder
  double scale = 1;
  double rotation = 0;  ///< degrees
};

/// Writes the environment into `folder` as an EXR, or copies an EXR or HDR that needs no change. An
/// orientation that is no rotation about y is resampled, at twice the resolution, and noted. Throws
/// SceneError, std::system_error.
WrittenEnvironment write_environment(const ImportedEnvironment& environment,
                                     const std::filesystem::path& folder,
                                     std::vector<ImportNote>& notes);

}  // namespace lacuna
