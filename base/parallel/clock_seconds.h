#pragma once

#include <time.h>

namespace lacuna {

/// Seconds of a POSIX clock.
inline double clock_seconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace lacuna
