#pragma once

#include <cstddef>
#include <cstdint>

namespace lacuna {

/// Settings of the retention of jobs and of disk space.
struct CareSettings {
  std::uint64_t disk_floor = 256 << 20;  ///< bytes; with less free, jobs wait and renderers stop
  std::size_t keep_jobs = 0;             ///< jobs that are over; 0: all
  double keep_days = 0;                  ///< since they ended; 0: no limit
};

}  // namespace lacuna
