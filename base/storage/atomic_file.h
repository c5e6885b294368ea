#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/storage/file_handle.h"

namespace lacuna {

/// Replaces a file atomically: a temporary file beside it, write, fsync, rename, fsync of the
/// folder. A reader sees the old or the new content, also after a power failure. On failure (disk
/// full, no permission) throws std::system_error that names the file, and the old content remains
/// or is restored. If only the last step failed and the old content cannot be restored, the new
/// content stays and nothing is thrown: the result agrees with the file.
class AtomicFile {
 public:
  /// `sync = false` omits both fsyncs, for data that may be lost (progress).
  explicit AtomicFile(std::filesystem::path file, bool sync = true);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Without commit(): keeps the old content and removes the temporary file.
  ~AtomicFile();

  /// Appends. Writeback to disk runs at most 8 MiB behind, so that many short calls wait for it
  /// instead of the final fsync, which cannot be interrupted. Blocks of zeros become holes, which
  /// take no time and no space: layers of rare strategies are mostly zeros.
  void write(std::string_view content);
  /// Overwrites bytes that were written.
  void write_at(std::uint64_t offset, std::string_view content);
  /// Completes the file and renames it to its name.
  void commit();

 private:
  void start_syncing();

  std::filesystem::path file_, temporary_;
  FileHandle handle_;
  bool sync_, ends_in_hole_ = false;
  std::uint64_t size_ = 0;
};

/// Replaces `file` by `content`, as AtomicFile.
void write_file_atomically(const std::filesystem::path& file, std::string_view content,
                           bool sync = true);

/// Reads a regular file of at most `max_bytes`, which must not be a symbolic link itself. Throws
/// std::system_error, or std::length_error if it is larger.
std::string read_file(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace lacuna
