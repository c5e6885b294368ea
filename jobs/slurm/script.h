#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

/// What the batch script of a submission does.
struct SlurmScript {
  std::string name;  ///< of the submission
  std::filesystem::path folder, renderer, data;
  std::vector<std::string> environment;  ///< "NAME=value", which hold whatever sbatch exports
  bool all_cores = false;                ///< the job names no threads: what Slurm gives it
};

/// Waits until the folder is there and names this submission, and until no earlier renderer has the
/// folder; then renders, hands SIGTERM on, and leaves the exit code in slurm.exit.
std::string script_text(const SlurmScript& script);

/// What the batch script of an array does: each of its tasks renders some runs of a sweep.
struct SlurmArrayScript {
  std::string name;  ///< of the submission
  std::filesystem::path sweep, renderer, directory;
  std::vector<std::string> environment;  ///< as that of SlurmScript
  std::vector<std::string> tasks;        ///< the runs of each, from task 1 on, as "1,4-7"
  bool all_cores = false;                ///< no run names threads
};

/// Waits until the sweep's folder is there and names this submission; then renders the task's runs,
/// and hands SIGTERM on.
std::string array_script_text(const SlurmArrayScript& script);

/// A text as one word of a shell.
std::string shell_word(const std::string& text);

}  // namespace lacuna
