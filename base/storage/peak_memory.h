#pragma once

#include <sys/resource.h>

#include <cstdint>

namespace lacuna {

/// The most main memory that this process has held so far, bytes.
inline std::uint64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace lacuna
