#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

namespace lacuna {

/// Owns a file descriptor.
class FileHandle {
 public:
  FileHandle() = default;
  explicit FileHandle(int fd) : fd_(fd) {}
  FileHandle(FileHandle&& o) noexcept : fd_(std::exchange(o.fd_, -1)) {}
  FileHandle& operator=(FileHandle&& o) noexcept {
    std::swap(fd_, o.fd_);
    return *this;
  }
  ~FileHandle();

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }
  int release() { return std::exchange(fd_, -1); }
  /// Closes now; false if this failed: some file systems report a full disk only here.
  bool close();

 private:
  int fd_ = -1;
};

/// Throws std::system_error: "cannot ACTION FILE: ..." with the reason in `error` (an errno).
[[noreturn]] void throw_file_error(int error, const std::string& action,
                                   const std::filesystem::path& file);

/// Opens a regular file for reading, which must not be a symbolic link itself, and sets its present
/// `size` in bytes. Throws std::system_error.
FileHandle open_regular_file(const std::filesystem::path& file, std::uint64_t& size);

/// Makes renames and new names in `folder` durable (fsync).
void sync_folder(const std::filesystem::path& folder);

/// A unique name beside `file`: hidden, ends in ".tmp", contains the process id.
std::filesystem::path temporary_name(const std::filesystem::path& file);

/// Removes the temporary files of killed processes from `folder`: their process does not exist on
/// this machine, and they were not modified for a minute (it may run on another machine).
void remove_stale_temporaries(const std::filesystem::path& folder);

/// The same for folders with such names, of any age. Only for the sole owner of `folder` on all
/// machines.
void remove_stale_folders(const std::filesystem::path& folder);

}  // namespace lacuna
