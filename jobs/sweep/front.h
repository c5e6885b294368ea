#pragma once

#include <optional>
#include <span>
#include <vector>

#include "jobs/sweep/compare.h"

namespace lacuna {

/// The input of pareto_front() for one cell: its curves, and the seconds of its preparation.
struct Contender {
  Replicates curves;
  double preparation = 0;
};

/// An interval of time in which one contender has the smallest mean error.
struct FrontPart {
  double from, to;
  std::size_t best;  ///< index of the contender
  std::vector<std::size_t>
      tied;      ///< others whose error does not differ significantly somewhere in it
  double error;  ///< mean error of the best at `to`
  bool at_floor = false;
};

/// The Pareto front of error against total time (preparation and rendering) over all contenders. A
/// finished picture remains available, so an error holds after the end of its curve. Contenders
/// whose runs have no common time are left out.
std::vector<FrontPart> pareto_front(std::span<const Contender> contenders);

/// The total time after which a cell's preparation has paid off against a baseline.
struct BreakEven {
  double seconds;
  bool from_the_start = false;  ///< the cell's error was never above the baseline's
};
/// The total time after which the mean error of `cell` stays at or below that of `baseline`, over
/// the times at which both were measured; none if there is no such time.
std::optional<BreakEven> break_even(const Contender& cell, const Contender& baseline);

}  // namespace lacuna
