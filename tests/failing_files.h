#pragma once

#include <fcntl.h>
#include <stdarg.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <filesystem>
#include <mutex>
#include <string>
#include <system_error>

namespace lacuna {

enum class FileCall { open, fsync };

/// While it lives, calls of open() or fsync() of this test program, on paths that end in `ending`,
/// fail with EIO: faults that no file system shows on demand. One object at a time.
class FailingFiles {
 public:
  /// `spared`: so many calls before go well; then so many fail.
  FailingFiles(FileCall call, std::string ending, int spared = 0, int failing = INT_MAX) {
    const std::lock_guard lock(mutex_);
    call_ = call;
    ending_ = std::move(ending);
    spared_ = spared;
    failing_ = failing;
  }
  ~FailingFiles() {
    const std::lock_guard lock(mutex_);
    ending_.clear();
  }
  FailingFiles(const FailingFiles&) = delete;
  FailingFiles& operator=(const FailingFiles&) = delete;

  static bool hits(FileCall call, const std::string& path) {
    const std::lock_guard lock(mutex_);
    if (ending_.empty() || call != call_ || !path.ends_with(ending_)) return false;
    return spared_-- <= 0 && failing_-- > 0;
  }

 private:
  inline static std::mutex mutex_;
  inline static FileCall call_{};
  inline static std::string ending_;
  inline static int spared_ = 0, failing_ = 0;
};

}  // namespace lacuna

// In the place of the C library's, for everything that is linked into the program.
extern "C" {
__attribute__((used)) inline int open(const char* path, int flags, ...) {
  mode_t mode = 0;
  if ((flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE) {
    va_list more;
    va_start(more, flags);
    mode = va_arg(more, mode_t);
    va_end(more);
  }
  if (lacuna::FailingFiles::hits(lacuna::FileCall::open, path)) return errno = EIO, -1;
  return static_cast<int>(::syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

__attribute__((used)) inline int fsync(int fd) {
  std::error_code unknown;
  const auto path = std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(fd), unknown);
  if (lacuna::FailingFiles::hits(lacuna::FileCall::fsync, path.string())) return errno = EIO, -1;
  return static_cast<int>(::syscall(SYS_fsync, fd));
}

// The database syncs its log so.
__attribute__((used)) inline int fdatasync(int fd) { return fsync(fd); }
}
