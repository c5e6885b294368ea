#pragma once

#include <array>
#include <cstdint>

#include "renderer/core/vec.h"
#include "renderer/path/contexts.h"

namespace lacuna {

/// A point of the empty space that a guide's settings name (RegionGuideSettings::through).
struct NamedRegion {
  V3d point;             ///< voxels
  std::uint32_t region;  ///< that contains the point
};

/// `through`: in the coordinates of the scene's file. Builds the regions. Throws SceneError with
/// the reason if the point lies in no region.
NamedRegion named_region(const std::array<double, 3>& through, const PrepareContext& context);

}  // namespace lacuna
