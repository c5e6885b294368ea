#pragma once

#include <Imath/ImathVec.h>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace lacuna {

/// A step of the analysis would take more memory than its caller allows. It has allocated nothing
/// of that size; the message names the step, the grid, what it would take and what is allowed.
class MemoryLimitError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

inline constexpr std::uint64_t no_memory_limit = std::numeric_limits<std::uint64_t>::max();

/// The longest side of a grid that coordinates of 16 bits reach.
inline constexpr int max_grid_side = 65535;

/// How many voxels a grid has. Throws std::invalid_argument on a side outside [0, max_grid_side].
std::uint64_t checked_voxels(Imath::V3i size);

/// Throws MemoryLimitError if `bytes` passes `byte_limit`. `step` is what would be built.
void require_memory(std::string_view step, Imath::V3i size, std::uint64_t bytes,
                    std::uint64_t byte_limit);

}  // namespace lacuna
