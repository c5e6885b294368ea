#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <stdexcept>

namespace lacuna {

/// Throws std::runtime_error if `bytes` exceed half of the free memory; `what()` returns what they
/// are for and how to need less.
template <class What>
void require_free(double bytes, What&& what) {
  const double free = double(sysconf(_SC_AVPHYS_PAGES)) * double(sysconf(_SC_PAGESIZE));
  if (bytes < free / 2) return;
  throw std::runtime_error(
      fmt::format("{}: {:.1f} GiB, more than half of the {:.1f} GiB that are "
                  "free",
                  what(), bytes / 0x1p30, free / 0x1p30));
}

}  // namespace lacuna
