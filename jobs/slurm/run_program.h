#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "jobs/slurm/slurm_programs.h"

namespace lacuna {

/// The program's file in PATH; empty: there is none.
std::filesystem::path find_program(const std::string& name);

/// This process's environment without what would change the answers of Slurm's programs: SLURM_*
/// but SLURM_CONF, SQUEUE_*, SACCT_*, SCANCEL_*.
std::vector<std::string> slurm_environment();

/// What a program has written to a file; no more than 64 MiB.
std::string program_output(int file);

/// Throws std::invalid_argument, which names `option`, if one of Slurm's programs is not in PATH.
void check_slurm_programs(const std::string& option);

/// Runs programs found in PATH as child processes in slurm_environment(), each for at most a
/// minute.
RunProgram spawning_runner();

}  // namespace lacuna
