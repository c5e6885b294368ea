#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "base/storage/file_handle.h"

namespace lacuna {

/// An flock on a dedicated file, exclusive among processes and threads. The kernel releases it when
/// the process ends, also when it is killed.
class FileLock {
 public:
  /// Creates the file if it is missing. None if the lock is held elsewhere. Throws
  /// std::system_error if the file cannot be created or the file system has no locks.
  static std::optional<FileLock> try_take(const std::filesystem::path& file);

  FileLock(FileLock&&) = default;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

  /// Writes `text`, which names the owner for people, into the file. Ignores errors.
  void note(std::string_view text) const;
  /// Also removes the file on release; the next owner creates a new one.
  void remove_at_end() { removes_ = true; }

 private:
  FileLock(std::filesystem::path file, FileHandle handle)
      : file_(std::move(file)), handle_(std::move(handle)) {}

  std::filesystem::path file_;
  FileHandle handle_;
  bool removes_ = false;
};

}  // namespace lacuna
