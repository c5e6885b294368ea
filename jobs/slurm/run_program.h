#pragma once

#include <filesystem>
#include <string>

#include "jobs/slurm/slurm_programs.h"

namespace lacuna {

/// Throws std::invalid_argument, which names `option`, if one of Slurm's programs is not in PATH.
void check_slurm_programs(const std::string& option);

/// Runs programs found in PATH in the working directory `directory`, each for at most a minute,
/// without environment variables that change their output: SLURM_* except SLURM_CONF, SQUEUE_*,
/// SACCT_*, SCANCEL_*.
RunProgram slurm_runner(std::filesystem::path directory);

}  // namespace lacuna
