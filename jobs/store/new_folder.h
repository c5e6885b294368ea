#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace lacuna {

/// Normalises a folder's path: absolute, without '.', '..' and a trailing '/'.
std::filesystem::path folder_path(const std::filesystem::path& named);

/// Creates a folder as a whole or not at all, even after a power cut: `fill` writes its contents
/// (synced) into a draft beside it, which is then renamed. Creates missing parent folders. Throws
/// std::system_error, and std::invalid_argument if `target` exists; neither the folder nor a draft
/// is left then, even if only the last sync failed. Where the folder cannot be taken back, it
/// stands and nothing is thrown.
void create_folder_whole(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path& draft)>& fill);

/// Takes back a folder that was just created. False: it cannot be, and stays as a whole.
bool take_folder_back(const std::filesystem::path& folder);

/// Renames sibling folders to hidden names, synced, and returns these names, to be removed later.
/// After a crash remove_stale_folders() removes them. Throws std::system_error if one cannot be
/// renamed or synced; then all have their old names.
std::vector<std::filesystem::path> take_folders_away(
    const std::vector<std::filesystem::path>& folders);
/// Removes a folder with its contents; after a crash midway, nothing has its name. Throws
/// std::system_error.
void remove_folder_whole(const std::filesystem::path& folder);

}  // namespace lacuna
