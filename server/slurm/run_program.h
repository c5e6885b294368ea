#pragma once

#include <filesystem>
#include <string>

#include "jobs/slurm/slurm_programs.h"

namespace lacuna {

/// Runs programs found in PATH as child processes, each for at most a minute, in the service's
/// environment without what would change the answers of Slurm's programs: SLURM_* but SLURM_CONF,
/// SQUEUE_*, SACCT_*, SCANCEL_*.
RunProgram slurm_runner(std::filesystem::path directory);

/// The program's file in PATH; empty: there is none.
std::filesystem::path find_program(const std::string& name);

}  // namespace lacuna
