#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/storage/bytes.h"

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

/// Called after each piece (piece_bytes) that is written, and between those that are read: what it
/// throws ends that.
using BetweenPieces = std::function<void()>;

/// Writes a checkpoint as a whole or not at all: a header with `key` (what picture it belongs to)
/// and a checksum, then the content that `save` puts, with the memory of one piece. Throws
/// std::system_error; then, and if `between` throws, the older checkpoint is still there.
void write_checkpoint(const std::filesystem::path& file, const std::string& key,
                      const std::function<void(ByteWriter&)>& save,
                      const BetweenPieces& between = {});

/// Gives the content of a checkpoint of the picture `key` to `load`, once it has the right
/// checksum; false if there is no file. Throws std::runtime_error that says why it cannot be used:
/// cut short, damaged, of another picture or version, or what `load` throws or leaves;
/// std::system_error.
bool read_checkpoint(const std::filesystem::path& file, const std::string& key,
                     const std::function<void(ByteReader&)>& load,
                     const BetweenPieces& between = {});

}  // namespace lacuna
