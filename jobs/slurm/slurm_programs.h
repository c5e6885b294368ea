#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lacuna {

/// Slurm's word that a job is over is believed when so many listings say so, and what its folder
/// has to say may be so many intervals late: shared file systems lag.
inline constexpr int slurm_listings_to_believe = 2;
inline constexpr int slurm_intervals_to_lag = 5;

/// How a program ended.
struct ProgramAnswer {
  int code = 0;      ///< exit code; 128 + signal
  std::string text;  ///< all that it printed, on both of its outputs
};
/// Runs a program to its end: the first word is its name. Throws std::system_error if it cannot be
/// started.
using RunProgram = std::function<ProgramAnswer(const std::vector<std::string>& words)>;

/// One of Slurm's programs failed; what() quotes its own words.
class SlurmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What Slurm says of one job.
struct SlurmJob {
  enum class Phase {
    waits,  ///< not begun, or to begin once more
    runs,
    over
  };
  std::int64_t id = 0;
  std::string name;
  std::string state;  ///< Slurm's word: "PENDING"
  std::string reason, nodes;
  Phase phase = Phase::runs;
  bool operator==(const SlurmJob&) const = default;
};
/// Of a word that this version does not know: `runs`, so that nothing is taken for over that is
/// not.
SlurmJob::Phase slurm_phase(std::string_view state);
/// Lines of squeue and sacct in the form that SlurmPrograms asks for; other lines are left out.
std::vector<SlurmJob> parse_slurm_jobs(std::string_view text);

/// sbatch, squeue, sacct, scancel and scontrol.
class SlurmPrograms {
 public:
  explicit SlurmPrograms(RunProgram run) : run_(std::move(run)) {}

  /// Gives the job's number. Throws SlurmError with sbatch's own words: whether there is a job now
  /// is not known then, for an answer can be lost on its way.
  std::int64_t submit(const std::vector<std::string>& words) const;
  /// All jobs of this user, those that have ended as long as the controller remembers them. Throws
  /// SlurmError.
  std::vector<SlurmJob> list() const;
  /// What the accounts say of jobs with these names; nothing where a cluster keeps none.
  std::vector<SlurmJob> account(const std::vector<std::string>& names) const;

  // All four: nothing happens if the job has ended. Throw SlurmError.
  void cancel(std::int64_t job) const;
  void cancel_if_waiting(std::int64_t job) const;
  /// Sends SIGTERM to the batch script and all that it has started.
  void terminate(std::int64_t job) const;
  void set_nice(std::int64_t job, int nice) const;

 private:
  std::string call(const std::vector<std::string>& words) const;
  RunProgram run_;
};

/// sbatch refused what the job asks for, and would refuse it each time.
bool refuses_the_job(std::string_view words);

}  // namespace lacuna
