#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace lacuna {

/// Normalises a folder's path: absolute, without '.', '..' and a trailing '/'.
std::filesystem::path folder_path(const std::filesystem::path& named);

/// Creates a folder atomically, even on a power failure: `fill` writes its contents (synced) into a
/// draft beside it, which is then renamed. Creates missing parent folders. Throws
/// std::system_error, and std::invalid_argument if `target` exists; then neither the folder nor a
/// draft remains, even if only the last sync failed. If the folder cannot be removed again, it
/// stays and nothing is thrown.
void create_folder_whole(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path& draft)>& fill);

/// Removes a folder that was just created. False if this fails; the folder then stays complete.
bool take_folder_back(const std::filesystem::path& folder);

/// Renames sibling folders to hidden names, synced, and returns these names for later removal.
/// After a crash remove_stale_folders() removes them. Throws std::system_error if one cannot be
/// renamed or synced; then all keep their old names.
std::vector<std::filesystem::path> take_folders_away(
    const std::vector<std::filesystem::path>& folders);
/// Removes a folder with its contents; after a crash midway the name is unused. Throws
/// std::system_error.
void remove_folder_whole(const std::filesystem::path& folder);

}  // namespace lacuna
