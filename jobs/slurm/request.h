#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "jobs/store/job_folder.h"

namespace lacuna {

/// The resources that a job requests from Slurm.
struct SlurmRequest {
  std::optional<int> minutes;  ///< none: unknown, and the partition's default applies
  std::int64_t megabytes = 0;
  int cores = 0;  ///< 0: an exclusive node with all its cores
  bool own_node = false;
  int nice = 0;
};

/// The input of a request in addition to the job.
struct RequestBasis {
  int cores = 0;                   ///< of a job that sets no threads; 0: all of a node
  std::uint64_t memory_limit = 0;  ///< bytes; 0: none, the memory is estimated
  std::uint64_t scene_bytes = 0;   ///< of the scene's file; 0: unknown
  int priority = 0;                ///< in [-max_priority, max_priority]
  int shortages = 0;               ///< its failed renderers; each doubles the estimate
};

/// Time: 1.25 times the budget, plus 15 minutes to load, analyse and write; the shorter of two time
/// budgets. None for a budget of only iterations or an error, and if a reference is rendered first,
/// which counts to no budget. Memory: the limit, or an estimate. Nice, from 0 to 2 max_priority,
/// rises as the priority falls, so no privilege is needed.
SlurmRequest slurm_request(const JobSpec& spec, const RequestBasis& basis);
int slurm_nice(int priority);

/// The request as arguments of sbatch.
std::vector<std::string> request_words(const SlurmRequest& request);

/// The arguments in --slurm-args, separated by blanks. Throws std::invalid_argument for an option
/// that Lacuna sets itself to find its jobs again.
std::vector<std::string> slurm_arguments(const std::string& text);

/// A path escaped for sbatch's file name patterns. Throws std::invalid_argument if that is
/// impossible.
std::string slurm_path(const std::filesystem::path& path);

}  // namespace lacuna
