#pragma once

#include <Imath/ImathVec.h>

#include <array>
#include <cstdint>
#include <vector>

namespace lacuna {

/// The input of the analysis: the triangles of a scene in world space, in any order. Every index is
/// below `positions.size()` and every coordinate is finite (the scene loader ensures it).
struct TriangleSoup {
  std::vector<Imath::V3f> positions;                    ///< scene units
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< three indices into `positions`
};

}  // namespace lacuna
