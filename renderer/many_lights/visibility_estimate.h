#pragma once

#include "renderer/many_lights/lanes.h"

namespace lacuna {

/// The estimated visibility of a block's lights at a shading point, computed by a visibility
/// strategy: `untested`, plus `gain` for each shadow ray that is traced and unoccluded.
struct VisibilityEstimate {
  std::uint64_t tests = 0;  ///< mask of the lights tested by a shadow ray
  Lanes untested;
  Lanes gain;  ///< for the lights in `tests`
};

}  // namespace lacuna
