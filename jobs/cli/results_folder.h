#pragma once

#include <filesystem>
#include <string>

#include "jobs/store/new_folder.h"

namespace lacuna {

/// The folder for the results of a file: `out` or, if empty, the file's name with `extension` in
/// the working directory. Absolute, without a trailing '/'.
inline std::filesystem::path results_folder(const std::filesystem::path& file,
                                            const std::filesystem::path& out,
                                            const std::string& extension) {
  return folder_path(out.empty() ? std::filesystem::path(file.stem().string() + extension) : out);
}

/// For CLI11: the error if a path does not exist; empty: none. Unlike CLI::ExistingPath throws
/// std::system_error if this cannot be determined.
inline std::string existing_path(const std::string& name) {
  const bool there = std::filesystem::exists(name);
  return there ? "" : "Path does not exist: " + name;
}

}  // namespace lacuna
