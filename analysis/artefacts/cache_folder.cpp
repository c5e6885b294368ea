#include "analysis/artefacts/cache_folder.h"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/storage/file_handle.h"
#include "base/storage/file_lock.h"

namespace lacuna {
namespace {

namespace fs = std::filesystem;
using std::chrono::system_clock;

constexpr std::string_view lock_suffix = ".lock";

/// Reads the file's size and time; false: not a regular file, or gone.
bool look_at(const fs::path& file, CacheEntry& entry) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  entry.file = file;
  entry.bytes = static_cast<std::uint64_t>(status.st_size);
  entry.used = system_clock::time_point(std::chrono::duration_cast<system_clock::duration>(
      std::chrono::seconds(status.st_mtim.tv_sec) +
      std::chrono::nanoseconds(status.st_mtim.tv_nsec)));
  return true;
}

bool is_lock_name(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(lock_suffix)) return false;
  return is_entry_name(name.substr(1, name.size() - 1 - lock_suffix.size()));
}

/// The files in a folder; none if it is missing.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    files.push_back(it->path());
  }
  if (error && error != std::errc::no_such_file_or_directory) {
    throw_file_error(error.value(), "list", folder);
  }
  return files;
}

/// The entries, most recently used first, without their headers.
std::vector<CacheEntry> entries_of(const fs::path& folder) {
  std::vector<CacheEntry> entries;
  for (const fs::path& file : files_in(folder)) {
    CacheEntry entry;
    if (is_entry_name(file.filename().string()) && look_at(file, entry)) {
      entries.push_back(std::move(entry));
    }
  }
  std::sort(entries.begin(), entries.end(), [](const CacheEntry& a, const CacheEntry& b) {
    return std::pair(b.used, a.file) < std::pair(a.used, b.file);
  });
  return entries;
}

/// Removes an entry if it is unchanged since it was listed. Holds its lock, so that an entry that
/// was just written in its place is not lost.
bool remove_entry(const CacheEntry& entry) {
  auto lock = FileLock::try_take(entry_lock_file(entry.file));
  if (!lock) return false;
  lock->remove_at_end();
  CacheEntry now;
  const bool same = look_at(entry.file, now) && now.used == entry.used;
  if (!same) return false;
  if (::unlink(entry.file.c_str()) == 0) return true;
  if (errno != ENOENT) throw_file_error(errno, "remove", entry.file);
  return false;
}

/// Removes the locks and half-written files of killed processes.
void tidy(const fs::path& folder) {
  for (const fs::path& file : files_in(folder)) {
    if (!is_lock_name(file.filename().string())) continue;
    if (auto lock = FileLock::try_take(file)) lock->remove_at_end();
  }
  remove_stale_temporaries(folder);
}

}  // namespace

fs::path entry_lock_file(const fs::path& entry) {
  return entry.parent_path() / fmt::format(".{}{}", entry.filename().string(), lock_suffix);
}

std::vector<CacheEntry> list_cache(const fs::path& folder, CacheCheck check) {
  std::vector<CacheEntry> entries = entries_of(folder);
  for (CacheEntry& entry : entries) {
    const auto look = check == CacheCheck::headers ? read_entry_header : verify_entry;
    entry.refusal = look(entry.file, entry.header);
  }
  // Removed by another process meanwhile.
  std::erase_if(entries, [](const CacheEntry& entry) {
    return entry.refusal && entry.refusal->fault == EntryFault::missing;
  });
  return entries;
}

CacheRemoval clear_cache(const fs::path& folder, std::chrono::seconds unused) {
  CacheRemoval removed;
  if (!fs::exists(folder)) return removed;
  const auto latest = system_clock::now() - unused;
  for (const CacheEntry& entry : entries_of(folder)) {
    if (entry.used > latest || !remove_entry(entry)) continue;
    ++removed.entries;
    removed.bytes += entry.bytes;
  }
  tidy(folder);
  return removed;
}

CacheRemoval trim_cache(const fs::path& folder, std::uint64_t byte_limit, const fs::path& keep) {
  CacheRemoval removed;
  try {
    tidy(folder);
    std::vector<CacheEntry> entries = entries_of(folder);
    std::uint64_t bytes = 0;
    for (const CacheEntry& entry : entries) bytes += entry.bytes;
    for (; bytes > byte_limit && !entries.empty(); entries.pop_back()) {
      const CacheEntry& oldest = entries.back();
      if (oldest.file.filename() == keep.filename() || !remove_entry(oldest)) continue;
      bytes -= oldest.bytes;
      ++removed.entries;
      removed.bytes += oldest.bytes;
    }
  } catch (const std::system_error&) {
    // A failure to remove entries does not concern the artefact.
  }
  return removed;
}

}  // namespace lacuna
