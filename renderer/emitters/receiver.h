#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// A point that light arrives at, as a light tree sees it.
struct Receiver {
  V3f x{0, 0, 0};
  /// Unit: the point receives light from the side of `n`. 0: from all directions alike.
  V3f n{0, 0, 0};
  bool both_sides = false;  ///< it receives light from the side of -n too
  /// Weight of light along the surface, against 1 for light along `n`; in (0, 1]. It is larger
  /// where a shading normal decides on the cosine.
  float least_cosine = 1;
};

}  // namespace lacuna
