#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace lacuna {

/// The input of the batch script of a submission.
struct SlurmScript {
  std::string name;  ///< of the submission
  std::filesystem::path folder, renderer, directory;
  std::vector<std::string> environment;  ///< "NAME=value", which override what sbatch exports
  bool all_cores = false;  ///< the job sets no threads: uses those that Slurm allocates
};

/// Waits until the folder exists and names this submission, and until no earlier renderer locks it;
/// then renders, forwards SIGTERM, and writes the exit code to slurm.exit.
std::string script_text(const SlurmScript& script);

/// A text quoted as one word of a shell.
std::string shell_word(const std::string& text);

}  // namespace lacuna
