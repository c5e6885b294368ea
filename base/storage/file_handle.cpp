#include "base/storage/file_handle.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <chrono>
#include <random>
#include <string_view>
#include <system_error>
#include <vector>

namespace lacuna {
namespace {

constexpr std::string_view temporary_suffix = ".tmp";

/// The process id in a name from temporary_name(); 0: another name.
pid_t owner_of(std::string_view name) {
  if (!name.starts_with('.') || !name.ends_with(temporary_suffix)) return 0;
  name.remove_suffix(temporary_suffix.size());
  const auto dash = name.rfind('-');
  const auto dot = name.rfind('.');
  if (dash == std::string_view::npos || dot == std::string_view::npos || dot > dash) return 0;
  pid_t pid = 0;
  const char* end = name.data() + dash;
  const auto [stop, error] = std::from_chars(name.data() + dot + 1, end, pid);
  return error == std::errc() && stop == end && pid > 0 ? pid : 0;
}

bool is_gone(pid_t pid) { return ::kill(pid, 0) != 0 && errno == ESRCH; }

}  // namespace

FileHandle::~FileHandle() { close(); }

bool FileHandle::close() {
  const int fd = release();
  return fd < 0 || ::close(fd) == 0;
}

void throw_file_error(int error, const std::string& action, const std::filesystem::path& file) {
  throw std::system_error(error, std::generic_category(),
                          fmt::format("cannot {} {}", action, file.string()));
}

FileHandle open_regular_file(const std::filesystem::path& file, std::uint64_t& size) {
  // O_NONBLOCK: opening a FIFO must not wait for a writer.
  FileHandle handle(
      ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY));
  if (!handle) throw_file_error(errno, errno == ELOOP ? "follow the link" : "read", file);
  struct stat info {};
  if (::fstat(handle.get(), &info) != 0) throw_file_error(errno, "read", file);
  if (!S_ISREG(info.st_mode)) {
    throw_file_error(S_ISDIR(info.st_mode) ? EISDIR : EINVAL, "read (no regular file)", file);
  }
  size = static_cast<std::uint64_t>(info.st_size);
  return handle;
}

void sync_folder(const std::filesystem::path& folder) {
  const FileHandle handle(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // EINVAL: a file system whose folders need no fsync.
  if (!handle || (::fsync(handle.get()) != 0 && errno != EINVAL)) {
    throw_file_error(errno, "sync folder", folder);
  }
}

std::filesystem::path temporary_name(const std::filesystem::path& file) {
  std::random_device random;
  return file.parent_path() / fmt::format(".{}.{}-{:08x}{:08x}{}", file.filename().string(),
                                          ::getpid(), random(), random(), temporary_suffix);
}

void remove_stale_temporaries(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  const auto untouched_since = fs::file_time_type::clock::now() - std::chrono::minutes(1);
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const pid_t owner = owner_of(entry.path().filename().string());
    if (owner == 0 || !is_gone(owner)) continue;
    std::error_code vanished;  // another process may remove it, too
    if (!fs::is_regular_file(entry.symlink_status(vanished))) continue;
    const auto touched = entry.last_write_time(vanished);
    if (!vanished && touched < untouched_since) stale.push_back(entry.path());
  }
  std::error_code ignored;  // what remains only takes space
  for (const fs::path& file : stale) fs::remove(file, ignored);
}

void remove_stale_folders(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::vector<fs::path> stale;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const pid_t owner = owner_of(entry.path().filename().string());
    if (owner == 0 || !is_gone(owner)) continue;
    std::error_code vanished;
    if (fs::is_directory(entry.symlink_status(vanished))) stale.push_back(entry.path());
  }
  std::error_code ignored;
  for (const fs::path& dir : stale) fs::remove_all(dir, ignored);
}

}  // namespace lacuna
