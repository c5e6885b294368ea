#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

/// What the batch script of a submission does.
struct SlurmScript {
  std::string name;  ///< of the submission
  std::filesystem::path folder, renderer, directory;
  std::vector<std::string> environment;  ///< "NAME=value", which hold whatever sbatch exports
  bool all_cores = false;                ///< the job names no threads: what Slurm gives it
};

/// Waits until the folder is there and names this submission, and until no earlier renderer has the
/// folder; then renders, hands SIGTERM on, and leaves the exit code in slurm.exit.
std::string script_text(const SlurmScript& script);

/// A text as one word of a shell.
std::string shell_word(const std::string& text);

}  // namespace lacuna
