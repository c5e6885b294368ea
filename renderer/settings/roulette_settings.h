#pragma once

#include <array>

#include "base/settings/field.h"

namespace lacuna {

/// What decides how often a path goes on.
enum class RouletteChoice { throughput, efficiency };

/// Edges before `efficiency` may end paths by their throughput (EfficiencyRoulette); its text below
/// says so.
inline constexpr int early_roulette_depth = 3;

template <>
struct EnumTable<RouletteChoice> {
  static constexpr std::array<EnumValue<RouletteChoice>, 2> values{{
      {RouletteChoice::throughput, "throughput",
       "from roulette_depth on by its throughput; a guided path by what it is still expected to "
       "gather, and it may split"},
      {RouletteChoice::efficiency, "efficiency",
       "at every vertex, by the variance and the rays of what is behind it: it ends or splits "
       "where that makes the picture more efficient (Rath et al. 2022); as throughput until "
       "enough paths are known, and again where the first iterations tell that it would lose. "
       "Where the sampler spreads the light evenly, by throughput from 3 edges on if that pays"},
  }};
};

}  // namespace lacuna
