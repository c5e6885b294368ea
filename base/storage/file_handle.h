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
  /// Closes now, and says whether that went well: some file systems report a full disk only here.
  bool close();

 private:
  int fd_ = -1;
};

/// Throws std::system_error: "cannot ACTION FILE: ..." with the reason in `error` (an errno).
[[noreturn]] void throw_file_error(int error, const std::string& action,
                                   const std::filesystem::path& file);

/// Opens a regular file to be read (through links no further than the name itself), and gives its
/// size in bytes as it is now. Throws std::system_error.
FileHandle open_regular_file(const std::filesystem::path& file, std::uint64_t& size);

/// Makes a rename or a new name in `folder` outlast a power cut.
void sync_folder(const std::filesystem::path& folder);

/// A name beside `file` that nothing else has: hidden, ends in ".tmp", tells the process it is of.
std::filesystem::path temporary_name(const std::filesystem::path& file);

/// Removes the temporary files in `folder` that killed processes left: their process is gone from
/// this machine and nobody has touched them for a minute (it may live on another machine).
void remove_stale_temporaries(const std::filesystem::path& folder);

/// The same for whole folders with such names. Only for who owns `folder` on every machine: it does
/// not wait for a minute.
void remove_stale_folders(const std::filesystem::path& folder);

}  // namespace lacuna
