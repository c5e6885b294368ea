#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace lacuna {

/// A step of the analysis would need more memory than its caller allows; thrown before allocation.
/// The message names the step, the grid, the memory needed and the limit.
class MemoryLimitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::uint64_t no_memory_limit = std::numeric_limits<std::uint64_t>::max();

/// The longest side of a grid with coordinates of 16 bits.
inline constexpr int max_grid_side = 65535;

/// Number of voxels of a grid. Throws std::invalid_argument on a side outside [0, max_grid_side].
std::uint64_t checked_voxels(Imath::V3i size);

/// Throws MemoryLimitError if `bytes` exceeds `byte_limit`. `step` names what would be built.
void require_memory(std::string_view step, Imath::V3i size, std::uint64_t bytes,
                    std::uint64_t byte_limit);

}  // namespace lacuna
