#pragma once

#include <cstdint>
#include <vector>

#include "renderer/core/vec.h"

namespace lacuna {

/// What a path from a light gives to a pixel that is another thread's. Kept in the order it was
/// made and added to the picture in the order of the parts that made it, so that sums have the same
/// bits for any number of threads.
struct Splat {
  Rgb value;     ///< unweighted
  float weight;  ///< MIS
  std::uint32_t pixel;
  std::uint16_t s;  ///< vertices made from the light
};

using Splats = std::vector<Splat>;

}  // namespace lacuna
