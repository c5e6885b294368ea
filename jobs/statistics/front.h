#pragma once

#include <optional>
#include <span>
#include <vector>

#include "jobs/statistics/compare.h"

namespace lacuna {

/// A cell as the front sees it: its curves, and the seconds that it spends before they begin.
struct Contender {
  Replicates curves;
  double preparation = 0;
};

/// From one time to another no cell has a smaller mean error than this one.
struct FrontPart {
  double from, to;
  std::size_t best;               ///< index of the contender
  std::vector<std::size_t> tied;  ///< others whose error could not be told from it, somewhere there
  double error;                   ///< its mean error at `to`
  bool at_floor = false;
};

/// The Pareto front of error against total time (preparation and rendering) over all contenders. A
/// picture that was finished stays: an error holds after its curve's end. Contenders without a
/// common time are left out.
std::vector<FrontPart> pareto_front(std::span<const Contender> contenders);

/// The total time from which on `cell`'s mean error is not above `baseline`'s, as long as both were
/// measured: when its preparation has paid. Nothing: not within the measured times.
struct BreakEven {
  double seconds;
  bool from_the_start = false;  ///< it never was above
};
std::optional<BreakEven> break_even(const Contender& cell, const Contender& baseline);

}  // namespace lacuna
