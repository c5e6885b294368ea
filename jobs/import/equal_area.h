#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// The point of the unit square that stands for a direction (unit) in an octahedral map of equal
/// areas: Clarberg, "Fast equal-area mapping of the (hemi)sphere using SIMD" (2008), as pbrt-v4's
/// pictures of the environment use it. The centre is +z, the corners are -z; the second coordinate
/// grows with the rows of the picture.
V2d equal_area_square(const V3d& direction);

}  // namespace lacuna
