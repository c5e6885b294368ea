#pragma once

#include <cstdint>
#include <vector>

#include "renderer/core/vec.h"

namespace lacuna {

/// A contribution of a light path to any pixel. Splats are stored in the order they were made and
/// added to the picture in the order of the parts that made them, so that sums have the same bits
/// for any number of threads.
struct Splat {
  Rgb value;     ///< unweighted
  float weight;  ///< MIS
  std::uint32_t pixel;
  std::uint16_t s;  ///< vertices sampled from the light
};

using Splats = std::vector<Splat>;

}  // namespace lacuna
