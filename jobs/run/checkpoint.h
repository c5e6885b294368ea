#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/storage/bytes.h"

namespace lacuna {

/// Identifies the picture of a checkpoint: rendering continues only from one with the same values.
struct CheckpointKey {
  std::string picture;  ///< picture_key()
  std::string scene;    ///< hashes of the files the picture depends on
  std::string version;  ///< of the program
  /// Names of the integrator's own layers, which are means over all iterations. Other layers are
  /// rendered at the end, so they may differ.
  std::string layers;
};
/// The key as one text.
std::string checkpoint_key(const CheckpointKey& key);

/// The key of the checkpoint `file`. Throws std::runtime_error if it is truncated or of another
/// format version; std::system_error.
CheckpointKey read_checkpoint_key(const std::filesystem::path& file);

/// Called after each written piece (piece_bytes), and between read ones; an exception ends writing
/// or reading.
using BetweenPieces = std::function<void()>;

/// Writes a checkpoint atomically: a header with `key` (the picture it belongs to) and a checksum,
/// then the content from `save`, with the memory of one piece. Throws std::system_error; then, and
/// if `between` throws, the older checkpoint remains.
void write_checkpoint(const std::filesystem::path& file, const std::string& key,
                      const std::function<void(ByteWriter&)>& save,
                      const BetweenPieces& between = {});

/// Verifies the checksum of a checkpoint of the picture `key` and passes its content to `load`;
/// false if there is no file. Throws std::runtime_error with the reason if it cannot be used:
/// truncated, damaged, of another picture or version, or an exception or unread rest of `load`;
/// std::system_error.
bool read_checkpoint(const std::filesystem::path& file, const std::string& key,
                     const std::function<void(ByteReader&)>& load,
                     const BetweenPieces& between = {});

}  // namespace lacuna
