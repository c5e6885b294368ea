#pragma once

#include <span>
#include <vector>

#include "jobs/sweep/answers.h"

namespace lacuna {

/// Runs that were rendered while the machine did something else: other processes or the host took
/// more than 5 % of the processors' time, or these ran 10 % slower than in the sweep's fastest run.
/// `results`: of all runs of the plan.
std::vector<Tainted> tainted_runs(std::span<const RunResult> results);

}  // namespace lacuna
