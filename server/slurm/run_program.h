#pragma once

#include <filesystem>

#include "jobs/slurm/slurm_programs.h"

namespace lacuna {

/// As spawning_runner() runs programs, for a process with many threads that hold locks of folders:
/// in the working directory `directory`.
RunProgram slurm_runner(std::filesystem::path directory);

}  // namespace lacuna
