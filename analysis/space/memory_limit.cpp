#include "analysis/space/memory_limit.h"

#include <fmt/format.h>

namespace lacuna {

std::uint64_t checked_voxels(Imath::V3i size) {
  for (int a = 0; a < 3; ++a)
    if (size[a] < 0 || size[a] > max_grid_side)
      throw std::invalid_argument(
          fmt::format("a grid of {} x {} x {} voxels: sides of 0 to {} are "
                      "allowed",
                      size.x, size.y, size.z, max_grid_side));
  return static_cast<std::uint64_t>(size.x) * static_cast<std::uint64_t>(size.y) *
         static_cast<std::uint64_t>(size.z);
}

void require_memory(std::string_view step, Imath::V3i size, std::uint64_t bytes,
                    std::uint64_t byte_limit) {
  if (bytes <= byte_limit) return;
  constexpr double mib = 1 << 20;
  throw MemoryLimitError(fmt::format(
      "{} of a grid of {} x {} x {} voxels would take {:.1f} MiB of memory; {:.1f} MiB are allowed",
      step, size.x, size.y, size.z, static_cast<double>(bytes) / mib,
      static_cast<double>(byte_limit) / mib));
}

}  // namespace lacuna
