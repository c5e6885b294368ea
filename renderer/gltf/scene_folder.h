#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

using Bytes = std::vector<std::uint8_t>;

/// Reads all files of a scene: only regular files inside the scene's own folder, and at most 2 GiB
/// in total.
class SceneFolder {
 public:
  /// The folder of `main_file`. Throws SceneError if there is none.
  explicit SceneFolder(const std::filesystem::path& main_file);

  /// The bytes of the scene's main file.
  Bytes read_main();

  /// The bytes of the file that a glTF `uri` names, percent-decoded. `place` names the reference in
  /// errors. Refuses whatever is absolute, has a scheme, climbs with `..`, leaves the folder by a
  /// symbolic link, or is not a regular file.
  Bytes read(const std::string& uri, const std::string& place);

 private:
  Bytes read_regular(const std::filesystem::path& file, const std::string& place);

  std::filesystem::path main_file_;
  std::filesystem::path root_;  ///< canonical
  std::uintmax_t bytes_left_;
};

/// Decodes %XX. Throws SceneError on a broken or zero escape.
std::string percent_decode(const std::string& uri, const std::string& place);

}  // namespace lacuna
