#pragma once

#include <span>
#include <vector>

#include "jobs/sweep/answers.h"

namespace lacuna {

/// Runs rendered while the machine was disturbed: other processes or the host used more than 5 % of
/// the processors' time, or the processors ran 10 % slower than in the sweep's fastest run.
/// `results`: of all runs of the plan.
std::vector<Tainted> tainted_runs(std::span<const RunResult> results);

}  // namespace lacuna
