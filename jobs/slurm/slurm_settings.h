#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace lacuna {

/// Default number of jobs that one queue has in Slurm at a time.
inline constexpr int slurm_jobs_at_a_time = 64;

/// Settings of the executor that submits jobs to Slurm.
struct SlurmSettings {
  std::vector<std::string> arguments;  ///< further arguments of sbatch; they override Lacuna's own
  int cores = 0;                       ///< of a job that sets no threads; 0: all of a node
  std::chrono::milliseconds poll{3000};  ///< between two calls of squeue
};

}  // namespace lacuna
