#include "server/queue/disk_watch.h"

#include "server/telemetry/log.h"

#include <sys/statvfs.h>

#include <cerrno>
#include <system_error>

namespace lacuna {

std::uint64_t DiskWatch::free_bytes() const {
  struct statvfs status {};
  if (::statvfs(folder_.c_str(), &status) != 0) {
    throw std::system_error(errno, std::generic_category(), folder_.string());
  }
  return static_cast<std::uint64_t>(status.f_bavail) * status.f_frsize;
}

bool DiskWatch::is_low() {
  const std::lock_guard lock(mutex_);
  try {
    const std::uint64_t room = free_bytes();
    const bool low = room < (low_ ? floor_ + floor_ / 10 : floor_);
    if (low != low_) {
      log::warn("{}: {:.0f} MB free, the floor is {:.0f} MB: {}", folder_.string(),
                1e-6 * static_cast<double>(room), 1e-6 * static_cast<double>(floor_),
                low ? "jobs wait" : "jobs go on");
    }
    low_ = low;
  } catch (const std::system_error& error) {
    log::error("{}", error.what());
  }
  return low_;
}

}  // namespace lacuna
