#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lacuna {

/// What picture a checkpoint belongs to: rendering continues only from one with the same values.
struct CheckpointKey {
  std::string picture;  ///< picture_key()
  std::string scene;    ///< hashes of the files the picture depends on
  std::string version;  ///< of the program
  /// Names of the integrator's own layers, which are means over all iterations. Other layers are
  /// rendered at the end, so they may change.
  std::string layers;
};
/// The same as one text.
std::string checkpoint_key(const CheckpointKey& key);

/// The key of the checkpoint `file`. Throws std::runtime_error: cut short, or of another version of
/// the format; std::system_error.
CheckpointKey read_checkpoint_key(const std::filesystem::path& file);

/// Writes a checkpoint as a whole or not at all: a header with `key` (what picture it belongs to)
/// and a checksum, then `content`. Throws std::system_error.
void write_checkpoint(const std::filesystem::path& file, const std::string& key,
                      const std::string& content);

/// The content of a checkpoint of the picture `key`; nothing if there is no file. Throws
/// std::runtime_error that says why it cannot be used: cut short, damaged, of another picture or
/// version.
std::optional<std::string> read_checkpoint(const std::filesystem::path& file,
                                           const std::string& key);

}  // namespace lacuna
