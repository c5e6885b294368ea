#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "renderer/race/noise.h"

namespace lacuna {

/// What a race found of each entrant: log(its error / the best one's); of those that it knows
/// nothing of with an infinite deviation.
using Verdict = std::vector<LogRatio>;

/// Verdicts of earlier jobs on the same picture at a similar budget. What is not there may be
/// kept; what is there stays.
struct VerdictMemory {
  /// Null: there is none.
  std::function<std::shared_ptr<const Verdict>()> find;
  std::function<void(const Verdict&)> keep;
};

}  // namespace lacuna
