#pragma once

#include <map>
#include <span>
#include <string>

#include "jobs/sweep/run_result.h"

namespace lacuna {

/// The finished runs that were made from another content of a file than the run of the same scene
/// that ended last, by their index, and the first file that differs: their errors are those of
/// another picture. `results`: of all runs of the plan. A run that did not record its inputs is not
/// among them.
std::map<std::size_t, std::string> stale_runs(std::span<const RunResult> results);

}  // namespace lacuna
