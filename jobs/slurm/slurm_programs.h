#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

/// Number of listings after which a job counts as over, and the intervals for which its folder may
/// lag behind on a shared file system.
inline constexpr int slurm_listings_to_believe = 2;
inline constexpr int slurm_intervals_to_lag = 5;

/// How a program ended.
struct ProgramAnswer {
  int code = 0;      ///< exit code; 128 + signal
  std::string text;  ///< everything printed on both outputs
};
/// Runs a program, named by the first word, to its end. Throws std::system_error if it cannot be
/// started.
using RunProgram = std::function<ProgramAnswer(const std::vector<std::string>& words)>;

/// One of Slurm's programs failed; what() quotes its output.
class SlurmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Slurm's record of one job.
struct SlurmJob {
  enum class Phase {
    waits,  ///< not begun, or requeued
    runs,
    over
  };
  std::int64_t id = 0;
  std::string name;
  std::string state;  ///< Slurm's name: "PENDING"
  std::string reason, nodes;
  Phase phase = Phase::runs;
  bool operator==(const SlurmJob&) const = default;
};
/// `runs` for an unknown state, so that no running job counts as over.
SlurmJob::Phase slurm_phase(std::string_view state);
/// Parses lines of squeue and sacct in the format that SlurmPrograms requests; skips other lines.
std::vector<SlurmJob> parse_slurm_jobs(std::string_view text);

/// sbatch, squeue, sacct, scancel and scontrol.
class SlurmPrograms {
 public:
  explicit SlurmPrograms(RunProgram run) : run_(std::move(run)) {}

  /// Returns the job's number. Throws SlurmError with sbatch's output; the job may exist
  /// nevertheless, because an answer can be lost.
  std::int64_t submit(const std::vector<std::string>& words) const;
  /// All jobs of this user, ended ones as long as the controller keeps them. Throws SlurmError.
  std::vector<SlurmJob> list() const;
  /// The accounting records of jobs with these names; empty if the cluster has no accounting.
  std::vector<SlurmJob> account(const std::vector<std::string>& names) const;

  // All four do nothing if the job has ended, and throw SlurmError.
  void cancel(std::int64_t job) const;
  void cancel_if_waiting(std::int64_t job) const;
  /// Sends SIGTERM to the batch script and all its children.
  void terminate(std::int64_t job) const;
  void set_nice(std::int64_t job, int nice) const;

 private:
  std::string call(const std::vector<std::string>& words) const;
  RunProgram run_;
};

/// Whether sbatch refused the job's request permanently.
bool refuses_the_job(std::string_view words);

}  // namespace lacuna
