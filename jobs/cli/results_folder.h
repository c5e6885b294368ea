#pragma once

#include <filesystem>
#include <string>

namespace lacuna {

/// Where the results of a file go: `out`, or, if that is empty, the file's name with `extension` in
/// the working directory. Absolute, without a '/' at its end.
inline std::filesystem::path results_folder(const std::filesystem::path& file,
                                            const std::filesystem::path& out,
                                            const std::string& extension) {
  const std::filesystem::path named =
      out.empty() ? std::filesystem::path(file.stem().string() + extension) : out;
  std::filesystem::path folder = std::filesystem::absolute(named).lexically_normal();
  return folder.has_filename() ? folder : folder.parent_path();
}

}  // namespace lacuna
