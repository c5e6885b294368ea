#pragma once

#include "renderer/many_lights/lanes.h"

namespace lacuna {

/// The estimated visibility of a block's lights at a shading point: `untested`, plus `gain` where a
/// shadow ray was traced and was unoccluded. Every visibility strategy fills this.
struct VisibilityEstimate {
  std::uint64_t tests = 0;  ///< mask of the lights tested by a shadow ray
  Lanes untested;
  Lanes gain;  ///< of those in `tests`
};

}  // namespace lacuna
