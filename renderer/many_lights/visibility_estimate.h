#pragma once

#include "renderer/many_lights/lanes.h"

namespace lacuna {

/// What is taken for the visibility of the lights of a block at a shading point: `untested`, plus
/// `gain` where a ray was sent and met nothing. Every choice of visibility is a way to fill this.
struct VisibilityEstimate {
  std::uint64_t tests = 0;  ///< lights to send a ray to
  Lanes untested;
  Lanes gain;  ///< of those in `tests`
};

}  // namespace lacuna
