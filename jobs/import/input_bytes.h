#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

namespace lacuna {

/// The bytes of a file, decompressed if they begin as those of gzip, of at most `max_bytes` in both
/// forms. Throws SceneError that names the file, InputUnreadable if it cannot be read now.
std::string read_unzipped(const std::filesystem::path& file, std::uint64_t max_bytes);

/// What a stream of gzip or zlib at the beginning of `bytes` holds. Throws SceneError with `label`
/// if it is damaged or longer than `max_bytes`.
std::string unzip(std::span<const std::uint8_t> bytes, std::uint64_t max_bytes,
                  const std::string& label);

}  // namespace lacuna
