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
  EntryHeader header;                          ///< as far as it could be read
  std::optional<EntryRefusal> refusal;         ///< none: the entry passed the check
};

enum class CacheCheck {
  headers,    ///< read the header only
  checksums,  ///< read and verify every byte
};

/// The entries of `folder`, most recently used first, without other files. A missing folder has no
/// entries. Throws std::system_error.
std::vector<CacheEntry> list_cache(const std::filesystem::path& folder, CacheCheck check);

/// What was removed.
struct CacheRemoval {
  std::size_t entries = 0;
  std::uint64_t bytes = 0;
};

/// Removes the entries that were not used for `unused`, and temporary files of killed processes.
/// Throws std::system_error if an entry cannot be removed.
CacheRemoval clear_cache(const std::filesystem::path& folder, std::chrono::seconds unused);

/// Removes the least recently used entries until the rest takes at most `byte_limit` bytes. Never
/// removes `keep`, or an entry that another process is writing. Entries that cannot be removed
/// stay.
CacheRemoval trim_cache(const std::filesystem::path& folder, std::uint64_t byte_limit,
                        const std::filesystem::path& keep);

/// The lock file that a process holds while it makes `entry`.
std::filesystem::path entry_lock_file(const std::filesystem::path& entry);

}  // namespace lacuna
