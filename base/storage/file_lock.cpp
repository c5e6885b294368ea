#include "base/storage/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

namespace lacuna {
namespace {

/// Whether the open file still has its name: it was not removed between open() and flock().
bool has_name(int fd, const std::filesystem::path& file) {
  struct stat held {
  }, named{};
  return ::fstat(fd, &held) == 0 && ::lstat(file.c_str(), &named) == 0 &&
         held.st_dev == named.st_dev && held.st_ino == named.st_ino;
}

}  // namespace

std::optional<FileLock> FileLock::try_take(const std::filesystem::path& file) {
  for (;;) {
    FileHandle handle(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666));
    if (!handle) throw_file_error(errno, "lock", file);
    while (::flock(handle.get(), LOCK_EX | LOCK_NB) != 0) {
      if (errno == EINTR) continue;
      if (errno == EWOULDBLOCK) return std::nullopt;
      throw_file_error(errno, "lock", file);
    }
    if (has_name(handle.get(), file)) return FileLock(file, std::move(handle));
  }
}

void FileLock::note(std::string_view text) const {
  if (::ftruncate(handle_.get(), 0) != 0) return;
  [[maybe_unused]] const ssize_t written = ::pwrite(handle_.get(), text.data(), text.size(), 0);
}

FileLock::~FileLock() {
  if (handle_ && removes_) ::unlink(file_.c_str());  // while it is still held
}

}  // namespace lacuna
