#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace lacuna {

/// The only thing the analysis floor knows of a scene: world-space triangles without any order.
/// Every index is below `positions.size()` and every coordinate is finite (the scene loader sees to
/// it).
struct TriangleSoup {
  std::vector<Imath::V3f> positions;                    ///< scene units
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three indices into `positions`
};

}  // namespace lacuna
