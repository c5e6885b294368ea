#pragma once

#include <filesystem>
#include <functional>

namespace lacuna {

/// Makes a folder that is there as a whole or not at all, also after a power cut: `fill` puts what
/// it holds into a draft beside it (synced), which is then renamed. Folders above it are made where
/// they lack. Throws std::system_error, and std::invalid_argument if `target` is there already; no
/// draft is left.
void create_folder_whole(const std::filesystem::path& target,
                         const std::function<void(const std::filesystem::path& draft)>& fill);

}  // namespace lacuna
