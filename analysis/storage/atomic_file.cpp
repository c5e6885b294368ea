#include "analysis/storage/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <stdexcept>
#include <system_error>

#include "analysis/storage/file_handle.h"

namespace lacuna {
namespace {

/// Removes a file unless it got its final name.
class Temporary {
 public:
  explicit Temporary(std::filesystem::path file) : file_(std::move(file)) {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (!renamed_) ::unlink(file_.c_str());
  }
  const std::filesystem::path& file() const { return file_; }
  void rename_to(const std::filesystem::path& final_name) {
    if (::rename(file_.c_str(), final_name.c_str()) != 0) {
      throw_file_error(errno, "replace", final_name);
    }
    renamed_ = true;
  }

 private:
  std::filesystem::path file_;
  bool renamed_ = false;
};

/// The old content of a file that is about to be replaced, under a second name.
class OldContent {
 public:
  explicit OldContent(const std::filesystem::path& file)
      : file_(file),
        kept_(temporary_name(file)),
        error_(::link(file.c_str(), kept_.file().c_str()) == 0 ? 0 : errno) {}

  /// Puts it back in its place, or removes the file that was not there before. False: it cannot.
  bool restore() {
    if (error_ == ENOENT) return ::unlink(file_.c_str()) == 0;
    if (error_ != 0) return false;  // a file system without links
    try {
      kept_.rename_to(file_);
      return true;
    } catch (const std::system_error&) {
      return false;
    }
  }

 private:
  const std::filesystem::path file_;
  Temporary kept_;
  int error_;
};

/// False, with errno, if not all of it could be written.
bool write_all(int fd, std::string_view content) {
  while (!content.empty()) {
    const ssize_t n = ::write(fd, content.data(), content.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    content.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

std::filesystem::path folder_of(const std::filesystem::path& file) {
  return file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
}

[[noreturn]] void throw_too_large(const std::filesystem::path& file, std::size_t max_bytes) {
  throw std::length_error(
      fmt::format("{} is too large; allowed: at most {} bytes", file.string(), max_bytes));
}

}  // namespace

void write_file_atomically(const std::filesystem::path& file, std::string_view content, bool sync) {
  const std::filesystem::path name = temporary_name(file);
  FileHandle handle(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!handle) throw_file_error(errno, "write", file);
  Temporary temporary(name);
  if (!write_all(handle.get(), content)) throw_file_error(errno, "write", file);
  if (sync && ::fsync(handle.get()) != 0) throw_file_error(errno, "sync", file);
  if (!handle.close()) throw_file_error(errno, "write", file);
  if (!sync) return temporary.rename_to(file);
  OldContent old(file);
  temporary.rename_to(file);
  try {
    sync_folder(folder_of(file));
  } catch (const std::system_error&) {
    if (old.restore()) throw;
  }
}

std::string read_file(const std::filesystem::path& file, std::size_t max_bytes) {
  std::uint64_t size = 0;
  const FileHandle handle = open_regular_file(file, size);
  if (size > max_bytes) throw_too_large(file, max_bytes);
  std::string content(static_cast<std::size_t>(size), '\0');
  std::size_t filled = 0;
  // A file that grows or shrinks meanwhile is read as far as it goes.
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
