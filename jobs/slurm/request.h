#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// What a job asks of Slurm.
struct SlurmRequest {
  std::optional<int> minutes;  ///< none: the length is not known, and the partition's own holds
  std::int64_t megabytes = 0;
  int cores = 0;  ///< 0: a node of its own, with all its cores
  bool own_node = false;
  int nice = 0;
};

/// What the request follows from beside the job itself.
struct RequestBasis {
  int cores = 0;                   ///< of a job that names no threads; 0: all of a node
  std::uint64_t memory_limit = 0;  ///< bytes; 0: none, and the memory is estimated
  std::uint64_t scene_bytes = 0;   ///< of the scene's file; 0: not known
  int priority = 0;                ///< in [-max_priority, max_priority]
  int shortages = 0;               ///< renderers of it that ended badly; each doubles the estimate
};

/// Time: the budget and a quarter, and 15 minutes to load, analyse and write; of a job with both
/// budgets the shorter. A budget of iterations or of an error alone says nothing of time, and a
/// reference that is rendered first counts to no budget: none. Memory: the limit, or an estimate.
/// Nice, from 0 to 2 max_priority, is higher the lower the priority: nobody has to be privileged.
SlurmRequest slurm_request(const JobSpec& spec, const RequestBasis& basis);
int slurm_nice(int priority);

/// As words for sbatch.
std::vector<std::string> request_words(const SlurmRequest& request);

/// Words of --slurm-args: separated by blanks. Throws std::invalid_argument for an option that
/// Lacuna needs itself to find its jobs again.
std::vector<std::string> slurm_arguments(const std::string& text);

/// A path as sbatch's patterns of file names take it. Throws std::invalid_argument if they cannot.
std::string slurm_path(const std::filesystem::path& path);

}  // namespace lacuna
