#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/storage/file_handle.h"

namespace lacuna {

/// Replaces a file as a whole: a temporary beside it, write, fsync, rename, fsync of the folder. A
/// reader sees the old content or the new, also after a power cut. What throws std::system_error
/// names the file (disk full, no permission); the old content is then there again, even if only the
/// last step failed. Where it cannot be put back, the new content stands and nothing is thrown:
/// what is told and what is seen agree.
class AtomicFile {
 public:
  /// `sync = false` leaves out both fsyncs, for what may be lost (progress).
  explicit AtomicFile(std::filesystem::path file, bool sync = true);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  /// Before commit(): the old content is still there, and no temporary is left.
  ~AtomicFile();

  /// Appends. The disk writes meanwhile, at most 8 MiB behind, so that many calls of few bytes
  /// wait for it rather than the one fsync, which nobody can stop. Blocks of zeros become holes,
  /// which take no time and no room: layers of rare strategies are nearly nothing else.
  void write(std::string_view content);
  /// Replaces bytes that were written.
  void write_at(std::uint64_t offset, std::string_view content);
  /// Ends the file and gives it its name.
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

/// The whole of a regular file (through links no further than the name itself), at most
/// `max_bytes`. Throws std::system_error, or std::length_error if it is larger.
std::string read_file(const std::filesystem::path& file, std::size_t max_bytes);

}  // namespace lacuna
