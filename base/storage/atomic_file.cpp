#include "base/storage/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace lacuna {
namespace {

/// Bytes between calls that start writeback. 900 MB take as long as with one fsync at their end
/// (1.2 and 1.4 s, medians of six), and half as long as with an fsync for each 8 MiB.
constexpr std::uint64_t window = std::uint64_t{4} << 20;
/// Granularity of holes: that of the page cache and of most file systems.
constexpr std::size_t block = 4096;

bool is_zero(std::string_view bytes) {
  return bytes.front() == 0 && std::memcmp(bytes.data(), bytes.data() + 1, bytes.size() - 1) == 0;
}

/// Keeps the old content of a file that is about to be replaced, by a hard link.
class OldContent {
 public:
  explicit OldContent(const std::filesystem::path& file)
      : file_(file),
        kept_(temporary_name(file)),
        error_(::link(file.c_str(), kept_.c_str()) == 0 ? 0 : errno) {}
  OldContent(const OldContent&) = delete;
  OldContent& operator=(const OldContent&) = delete;
  ~OldContent() {
    if (error_ == 0) ::unlink(kept_.c_str());
  }

  /// Restores the old content, or removes the file if there was none. False if this fails.
  bool restore() {
    if (error_ == ENOENT) return ::unlink(file_.c_str()) == 0;
    if (error_ != 0) return false;  // a file system without links
    return ::rename(kept_.c_str(), file_.c_str()) == 0;
  }

 private:
  const std::filesystem::path file_, kept_;
  const int error_;
};

/// Number of bytes of `content`, at `offset` of a file, before its first block of zeros.
std::size_t bytes_before_hole(std::uint64_t offset, std::string_view content) {
  std::size_t n = std::min<std::size_t>(content.size(), (block - offset % block) % block);
  while (n + block <= content.size() && !is_zero(content.substr(n, block))) n += block;
  return n + block <= content.size() ? n : content.size();
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

[[noreturn]] void throw_too_large(const std::filesystem::path& file, std::size_t max_bytes) {
  throw std::length_error(
      fmt::format("{} is too large; allowed: at most {} bytes", file.string(), max_bytes));
}

}  // namespace

AtomicFile::AtomicFile(std::filesystem::path file, bool sync)
    : file_(std::move(file)), temporary_(temporary_name(file_)), sync_(sync) {
  handle_ = FileHandle(::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!handle_) throw_file_error(errno, "write", file_);
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::string_view content) {
  while (!content.empty()) {
    const std::string_view part = content.substr(0, window - size_ % window);
    const std::size_t n = bytes_before_hole(size_, part);
    write_at(size_, part.substr(0, n));
    size_ += n;
    ends_in_hole_ = n < part.size();
    if (ends_in_hole_) size_ += block;
    content.remove_prefix(std::min(part.size(), n + block));
    if (sync_ && size_ % window == 0) start_syncing();
  }
}

void AtomicFile::start_syncing() {
  const auto range = [&](std::uint64_t from, unsigned flags) {
    const int done = ::sync_file_range(handle_.get(), static_cast<off_t>(from), window, flags);
    // Some file systems do not support this, and fsync follows; but an error is reported only once.
    if (done != 0 && (errno == EIO || errno == ENOSPC || errno == EDQUOT)) {
      throw_file_error(errno, "sync", file_);
    }
  };
  range(size_ - window, SYNC_FILE_RANGE_WRITE);
  if (size_ < 2 * window) return;
  range(size_ - 2 * window,
        SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER);
}

void AtomicFile::write_at(std::uint64_t offset, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n =
        ::pwrite(handle_.get(), content.data(), content.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw_file_error(errno, "write", file_);
    content.remove_prefix(static_cast<std::size_t>(n));
    offset += static_cast<std::uint64_t>(n);
  }
}

void AtomicFile::commit() {
  if (ends_in_hole_ && ::ftruncate(handle_.get(), static_cast<off_t>(size_)) != 0) {
    throw_file_error(errno, "write", file_);
  }
  if (sync_ && ::fsync(handle_.get()) != 0) throw_file_error(errno, "sync", file_);
  if (!handle_.close()) throw_file_error(errno, "write", file_);
  std::optional<OldContent> old;
  if (sync_) old.emplace(file_);
  if (::rename(temporary_.c_str(), file_.c_str()) != 0) throw_file_error(errno, "replace", file_);
  temporary_.clear();
  if (!sync_) return;
  try {
    sync_folder(folder_of(file_));
  } catch (const std::system_error&) {
    if (old->restore()) throw;
  }
}

void write_file_atomically(const std::filesystem::path& file, std::string_view content, bool sync) {
  AtomicFile out(file, sync);
  out.write(content);
  out.commit();
}

std::string read_file(const std::filesystem::path& file, std::size_t max_bytes) {
  std::uint64_t size = 0;
  const FileHandle handle = open_regular_file(file, size);
  if (size > max_bytes) throw_too_large(file, max_bytes);
  std::string content(static_cast<std::size_t>(size), '\0');
  std::size_t filled = 0;
  // The file may grow or shrink meanwhile: read up to its end.
  for (;;) {
    if (filled == content.size()) content.resize(content.size() + 4096);
    const ssize_t n = ::read(handle.get(), content.data() + filled, content.size() - filled);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw_file_error(errno, "read", file);
    filled += static_cast<std::size_t>(n);
    if (filled > max_bytes) throw_too_large(file, max_bytes);
    if (n == 0) break;
  }
  content.resize(filled);
  return content;
}

}  // namespace lacuna
