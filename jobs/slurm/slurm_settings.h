#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace lacuna {

/// Jobs that Slurm has of one queue at a time, unless a person says more.
inline constexpr int slurm_jobs_at_a_time = 64;

/// Settings of the executor that hands jobs to Slurm.
struct SlurmSettings {
  std::vector<std::string> arguments;    ///< further words for sbatch; they win over Lacuna's own
  int cores = 0;                         ///< of a job that names no threads; 0: all of a node
  std::chrono::milliseconds poll{3000};  ///< between two calls of squeue
};

}  // namespace lacuna
