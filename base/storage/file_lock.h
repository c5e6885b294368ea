#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "base/storage/file_handle.h"

namespace lacuna {

/// flock on a file of its own: among processes and among threads one at most has it. The kernel
/// releases it when the process dies, however it dies, so a killed owner keeps nobody waiting.
class FileLock {
 public:
  /// Makes the file if it is not there. Nothing if somebody else has it. Throws std::system_error
  /// where the file cannot be made, or a file system knows no locks.
  static std::optional<FileLock> try_take(const std::filesystem::path& file);

  FileLock(FileLock&&) = default;
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

  /// The file still has its name: nobody has removed it or put another in its place.
  bool is_named() const;
  /// Replaces what the file says, for people who ask who has it. Whether it could be written does
  /// not matter.
  void note(std::string_view text) const;
  /// Removes the file, too, when this lock ends: whoever waits for it makes a new one.
  void remove_at_end() { removes_ = true; }

 private:
  FileLock(std::filesystem::path file, FileHandle handle)
      : file_(std::move(file)), handle_(std::move(handle)) {}

  std::filesystem::path file_;
  FileHandle handle_;
  bool removes_ = false;
};

}  // namespace lacuna
