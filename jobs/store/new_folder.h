#pragma once

#include <filesystem>
#include <functional>
#include <vector>

namespace lacuna {

/// The folder that is meant: absolute, without '.', '..' and a '/' at its end.
std::filesystem::path folder_path(const std::filesystem::path& named);

/// Makes a folder that is there as a whole or not at all, also after a power cut: `fill` puts what
/// it holds into a draft beside it (synced), which is then renamed. Folders above it are made where
/// they lack. Throws std::system_error, and std::invalid_argument if `target` is there already; no
/// draft is left.
void create_folder_whole(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path& draft)>& fill);

/// Takes folders that lie beside each other away, synced: they get hidden names, which are given
/// back, to be removed when there is time. After a crash remove_stale_folders() does that. Throws
/// std::system_error if one cannot be taken: all have their names then.
std::vector<std::filesystem::path> take_folders_away(
    const std::vector<std::filesystem::path>& folders);
/// Removes a folder and all in it; a crash midway leaves nothing that has its name. Throws
/// std::system_error.
void remove_folder_whole(const std::filesystem::path& folder);

}  // namespace lacuna
