#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/run/input_check.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// What `lacuna archive --check` finds.
struct ArchiveCheck {
  std::size_t files = 0, runs = 0;
  std::vector<std::string> differences;  ///< one line each; empty: none
  std::vector<std::string> notes;        ///< what does not speak against the results
};

/// Compares an archive, or the manifest.json of one that was extracted, with itself (every file by
/// its hash), with this program and machine, and its left out inputs with those below the scenes
/// roots. With a sweep `against`, also the final errors: a cell differs if the 95 % interval of the
/// ratio of geometric means excludes 1 (two seeds or more on both sides). Extracts nothing. Throws
/// std::runtime_error for a damaged archive or manifest, std::system_error, the exceptions of
/// answer().
ArchiveCheck check_archive(const std::filesystem::path& file, InputCheck& inputs,
                           const std::optional<SweepFolder>& against);

}  // namespace lacuna
