#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace lacuna {

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
