#pragma once

#include <map>
#include <span>
#include <string>

#include "jobs/sweep/run_result.h"

namespace lacuna {

/// The finished runs with other contents of an input file than the run of the same scene that ended
/// last, by index, with the first differing file: their errors are of another picture. `results`:
/// of all runs of the plan. Excludes runs that did not record their inputs.
std::map<std::size_t, std::string> stale_runs(std::span<const RunResult> results);

}  // namespace lacuna
