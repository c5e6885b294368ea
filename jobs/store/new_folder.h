#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace lacuna {

/// Normalises a folder's path: absolute, without '.', '..' and a trailing '/'.
std::filesystem::path folder_path(const std::filesystem::path& named);

/// Creates a folder as a whole or not at all, even after a power cut: `fill` writes its contents
/// (synced) into a draft beside it, which is then renamed. Creates missing parent folders. Throws
/// std::system_error, and std::invalid_argument if `target` exists; no draft is left.
void create_folder_whole(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path& draft)>& fill);

/// Renames sibling folders to hidden names, synced, and returns these names, to be removed later.
/// After a crash remove_stale_folders() removes them. Throws std::system_error if one cannot be
/// renamed; then all have their old names.
std::vector<std::filesystem::path> take_folders_away(
    const std::vector<std::filesystem::path>& folders);
/// Removes a folder with its contents; after a crash midway, nothing has its name. Throws
/// std::system_error.
void remove_folder_whole(const std::filesystem::path& folder);

}  // namespace lacuna
