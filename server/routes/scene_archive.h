#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>

namespace lacuna {

/// The scene in an archive, at its top or in its only folder.
inline constexpr const char* archived_scene = "scene.glb";
inline constexpr std::uint64_t max_unpacked_bytes = std::uint64_t{1} << 30;
inline constexpr int max_archived_files = 10'000;

/// An archive that is not unpacked; what() names the entry.
class BadArchive : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Unpacks a ZIP archive of a scene's folder, as `lacuna import` writes it, into the new folder
/// `folder`, which gets scene.glb and what it refers to. Only regular files with plain relative
/// names come out of it, each once, at most `max_bytes` together; what macOS adds (`__MACOSX/`,
/// `.DS_Store`) stays behind. All is on the disk at the end. Throws BadArchive, or
/// std::system_error if a file cannot be written.
void unpack_scene(const std::filesystem::path& archive, const std::filesystem::path& folder,
                  std::uint64_t max_bytes = max_unpacked_bytes);

}  // namespace lacuna
