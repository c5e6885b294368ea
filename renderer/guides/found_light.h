#pragma once

#include "renderer/core/vec.h"

namespace lacuna {

/// Light that a path found from a vertex: what directions are learned from.
struct FoundLight {
  V3f x;           ///< of the vertex, scene units
  V3f w;           ///< unit; where it came from
  float distance;  ///< to there, scene units; infinite from the background
  float weight;    ///< > 0, finite: the light over the density with which `w` was sampled
};

}  // namespace lacuna
