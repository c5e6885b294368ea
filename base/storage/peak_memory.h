#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace lacuna {

/// Peak resident memory of this process, bytes.
inline std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace lacuna
