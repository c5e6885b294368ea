#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "analysis/artefacts/entry_file.h"

namespace lacuna {

/// One entry in a cache's folder.
struct CacheEntry {
  std::filesystem::path file;
  std::uint64_t bytes = 0;
  std::chrono::system_clock::time_point used;  ///< when it was last written or loaded
  EntryHeader header;                          ///< what could be read of it
  std::optional<EntryRefusal> refusal;         ///< nothing: all is well, as far as was looked
};

enum class CacheCheck {
  headers,    ///< only what an entry says of itself
  checksums,  ///< every byte
};

/// The entries of `folder`, the last used first; other files are left out. A folder that is not
/// there has none. Throws std::system_error.
std::vector<CacheEntry> list_cache(const std::filesystem::path& folder, CacheCheck check);

/// What was removed.
struct CacheRemoval {
  std::size_t entries = 0;
  std::uint64_t bytes = 0;
};

/// Removes the entries that nobody has used for `unused`, and what processes that were killed left.
/// Throws std::system_error for one that cannot be removed.
CacheRemoval clear_cache(const std::filesystem::path& folder, std::chrono::seconds unused);

/// Removes the entries that were not used for the longest time until the rest has `byte_limit` or
/// less; never `keep`, nor one that somebody makes anew meanwhile. What cannot be removed stays.
CacheRemoval trim_cache(const std::filesystem::path& folder, std::uint64_t byte_limit,
                        const std::filesystem::path& keep);

/// The file that whoever makes `entry` has locked.
std::filesystem::path entry_lock_file(const std::filesystem::path& entry);

}  // namespace lacuna
