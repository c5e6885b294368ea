// A library to preload: each n-th call below a folder that opens, writes, syncs, renames or makes
// something fails, with one error after another, as long as a file says so. Of the environment:
//   LACUNA_FAIL_UNDER: the folder; LACUNA_FAIL_WHILE: the file, whose text is n
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace {

constexpr std::array errors{ENOSPC, EIO, EMFILE, EROFS};

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

bool is_under(std::string_view path) {
  static const char* const folder = std::getenv("LACUNA_FAIL_UNDER");
  return folder != nullptr && path.starts_with(folder);
}

/// 0: no call fails now.
int failing_period() {
  static const char* const file = std::getenv("LACUNA_FAIL_WHILE");
  if (file == nullptr) return 0;
  static const auto open_file = next<int (*)(const char*, int, ...)>("open");
  static const auto read_file = next<ssize_t (*)(int, void*, size_t)>("read");
  const int fd = open_file(file, O_RDONLY | O_CLOEXEC);
  if (fd < 0) return 0;
  std::array<char, 16> text{};
  const ssize_t n = read_file(fd, text.data(), text.size() - 1);
  ::close(fd);
  return n > 0 ? std::atoi(text.data()) : 0;
}

/// Whether this call is one that fails; then errno says how.
bool fails() {
  static std::atomic<int> calls{0}, failed{0};
  const int before = errno;
  const int period = failing_period();
  errno = before;
  if (period <= 0 || ++calls % period != 0) return false;
  errno = errors[static_cast<std::size_t>(failed++) % errors.size()];
  return true;
}

bool fails_on(const char* path) { return is_under(path) && fails(); }

bool fails_on(int fd) {
  std::array<char, 32> link{};
  std::array<char, PATH_MAX> path{};
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", fd);
  return ::readlink(link.data(), path.data(), path.size() - 1) > 0 && is_under(path.data()) &&
         fails();
}

int open_as(const char* name, const char* path, int flags, mode_t mode) {
  if (fails_on(path)) return -1;
  return next<int (*)(const char*, int, ...)>(name)(path, flags, mode);
}

mode_t mode_of(int flags, va_list more) {
  const bool given = (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE;
  return given ? static_cast<mode_t>(va_arg(more, int)) : 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_as("open", path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = mode_of(flags, more);
  va_end(more);
  return open_as("open64", path, flags, mode);
}

ssize_t write(int fd, const void* data, size_t bytes) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t)>("write");
  return fails_on(fd) ? -1 : real(fd, data, bytes);
}

ssize_t pwrite64(int fd, const void* data, size_t bytes, off64_t place) {
  static const auto real = next<ssize_t (*)(int, const void*, size_t, off64_t)>("pwrite64");
  return fails_on(fd) ? -1 : real(fd, data, bytes, place);
}

int fsync(int fd) {
  static const auto real = next<int (*)(int)>("fsync");
  return fails_on(fd) ? -1 : real(fd);
}

int fdatasync(int fd) {
  static const auto real = next<int (*)(int)>("fdatasync");
  return fails_on(fd) ? -1 : real(fd);
}

int rename(const char* from, const char* to) {
  static const auto real = next<int (*)(const char*, const char*)>("rename");
  return fails_on(from) ? -1 : real(from, to);
}

int mkdir(const char* path, mode_t mode) {
  static const auto real = next<int (*)(const char*, mode_t)>("mkdir");
  return fails_on(path) ? -1 : real(path, mode);
}

}  // extern "C"
