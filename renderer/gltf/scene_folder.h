#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "base/storage/input_file.h"

namespace lacuna {

using Bytes = InputBytes;

/// Reads all files of a scene: only regular files inside the scene's own folder, and at most 2 GiB
/// in total. All functions throw InputUnreadable if the cause may be temporary.
class SceneFolder {
 public:
  /// The folder of `main_file`. Throws SceneError if there is none.
  explicit SceneFolder(const std::filesystem::path& main_file);

  /// The bytes of the scene's main file.
  Bytes read_main();

  /// The bytes of the file that a glTF `uri` names, percent-decoded, with `\` read as `/`. `place`
  /// names the reference in errors. Refuses whatever is absolute, has a scheme, climbs with `..`,
  /// leaves the folder by a symbolic link, or is not a regular file.
  Bytes read(const std::string& uri, const std::string& place, InputRole role);

  /// The file that read() would open. Throws as read().
  std::filesystem::path find(const std::string& uri, const std::string& place) const;

  /// All files that were read, each once, in the order of their first reading; the main file has no
  /// name.
  const std::vector<InputFile>& inputs() const { return inputs_; }

 private:
  Bytes read_regular(const std::filesystem::path& file, const std::string& place, InputFile about);

  std::filesystem::path main_file_;
  std::filesystem::path root_;  ///< canonical
  std::uintmax_t bytes_left_;
  std::vector<InputFile> inputs_;
};

/// Decodes %XX. Throws SceneError on a broken or zero escape.
std::string percent_decode(const std::string& uri, const std::string& place);

}  // namespace lacuna
