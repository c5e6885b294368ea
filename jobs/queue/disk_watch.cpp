#include "jobs/queue/disk_watch.h"

#include <fmt/format.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/log/log.h"

namespace lacuna {
namespace {

// A job's folder has a dozen files, each of which is first written to a temporary.
constexpr std::uint64_t most_inodes_kept = 1024, inode_share = 16;

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.0f} MB", 1e-6 * static_cast<double>(bytes));
}

}  // namespace

std::string shortage_of(const DiskRoom& room, std::uint64_t floor, bool was_low) {
  const auto needed = [&](std::uint64_t least) { return was_low ? least + least / 10 : least; };
  if (room.bytes < needed(floor)) {
    return fmt::format("{} are free on the disk, the floor is {}", megabytes(room.bytes),
                       megabytes(floor));
  }
  const std::uint64_t inodes = std::min(most_inodes_kept, room.all_inodes / inode_share);
  if (floor > 0 && room.inodes < needed(inodes)) {
    return fmt::format("{} inodes are free on the disk, the floor is {}", room.inodes, inodes);
  }
  return {};
}

DiskRoom DiskWatch::room() const {
  struct statvfs status {};
  if (::statvfs(folder_.c_str(), &status) != 0) {
    throw std::system_error(errno, std::generic_category(), folder_.string());
  }
  return {static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize, status.f_favail,
          status.f_files};
}

bool DiskWatch::is_low() {
  const std::lock_guard lock(mutex_);
  try {
    std::string shortage = shortage_of(room(), floor_, !shortage_.empty());
    if (shortage.empty() != shortage_.empty()) {
      log::warn(
          "{}: {}", folder_.string(),
          shortage.empty() ? "enough free space again: jobs continue" : shortage + ": jobs wait");
    }
    shortage_ = std::move(shortage);
  } catch (const std::system_error& error) {
    log::error("{}", error.what());
  }
  return !shortage_.empty();
}

std::string DiskWatch::shortage() const {
  const std::lock_guard lock(mutex_);
  return shortage_;
}

}  // namespace lacuna
