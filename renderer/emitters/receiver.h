#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// A receiver of light, as a light tree needs it.
struct Receiver {
  V3f x{0, 0, 0};
  /// Unit: receives light from the side of `n`. 0: receives light from all directions equally.
  V3f n{0, 0, 0};
  bool both_sides = false;  ///< also receives light from the side of -n
  /// Weight of light at grazing angles, relative to 1 for light along `n`; in (0, 1]. Larger if a
  /// shading normal determines the cosine.
  float least_cosine = 1;
};

}  // namespace lacuna
