#pragma once

#include <filesystem>
#include <string>

#include "jobs/store/new_folder.h"

namespace lacuna {

/// Where the results of a file go: `out`, or, if that is empty, the file's name with `extension` in
/// the working directory. Absolute, without a '/' at its end.
inline std::filesystem::path results_folder(const std::filesystem::path& file,
                                            const std::filesystem::path& out,
                                            const std::string& extension) {
  return folder_path(out.empty() ? std::filesystem::path(file.stem().string() + extension) : out);
}

}  // namespace lacuna
