#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "jobs/slurm/request.h"
#include "jobs/slurm/script.h"
#include "jobs/slurm/slurm_programs.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

class Terminal;

struct SlurmSweepSettings {
  std::vector<std::string> arguments;    ///< further words for sbatch
  std::chrono::milliseconds poll{3000};  ///< between two calls of squeue
  int cores = 0;                         ///< of a run that names no threads; 0: a node of its own
  std::size_t chunk = 0;    ///< runs of a task; 0: so that there are at most 1000 tasks
  int tasks_at_a_time = 0;  ///< 0: as many as Slurm likes
};

/// "1,4-7,9": as tasks of an array are named.
std::string index_ranges(const std::vector<std::size_t>& indices);

/// Does a sweep's runs as an array of Slurm, whose tasks are `lacuna sweep --index` on a part of
/// them each. The submission is written to the sweep's folder before it is made; whoever comes
/// after a crash looks it up by its name and goes on with it. What a submission leaves undone is
/// submitted again, as long as each brings something.
class SlurmSweep {
 public:
  SlurmSweep(const SweepFolder& sweep, SlurmSweepSettings settings, RunProgram run,
             Terminal& terminal);

  /// Until all `runs` (their indices, from 1, and where they stand) are over, or `interrupted`:
  /// then what was submitted goes on without this process. Gives an exit code. Throws BadJob where
  /// another process does the same, and std::system_error.
  int run(const std::map<std::size_t, JobState>& runs, const std::function<bool()>& interrupted);

 private:
  /// What Slurm has said of one submission.
  struct Seen {
    int gone = 0;         ///< listings, one after another, in which nothing of it waits or runs
    bool listed = false;  ///< ever
    std::vector<SlurmJob> ended;  ///< tasks that are over, in the last listing that had them
  };

  SlurmRequest deal(SlurmArrayScript& script, const ScenesRoots& scenes) const;
  void submit();
  bool follow(const std::function<bool()>& interrupted);
  bool list(Seen& seen);
  bool is_over(const Seen& seen) const;
  bool judge(const Seen& seen);
  void look_at_runs(std::size_t most);
  void report(std::size_t index, const JobState& state);
  std::vector<std::string> words(std::size_t tasks, const std::vector<std::string>& request) const;
  std::int64_t progress() const;

  const SweepFolder& sweep_;
  const SlurmSweepSettings settings_;
  const SlurmPrograms programs_;
  Terminal& terminal_;
  const JobFolder record_;               ///< where the submission stands: the sweep's own folder
  std::string name_;                     ///< of the submission
  std::int64_t job_ = 0;                 ///< Slurm's number; 0: not known
  std::string said_;                     ///< by sbatch, where it gave no number
  std::vector<std::size_t> open_;        ///< runs that are not over
  std::map<std::size_t, int> attempts_;  ///< renderers of each, before this command
  std::size_t all_ = 0, looked_ = 0, finished_ = 0, failed_ = 0;
  std::string trouble_;  ///< with squeue, told already
  int fruitless_ = 0, shortages_ = 0;
  std::int64_t reached_ = 0;  ///< progress() before the submission
};

}  // namespace lacuna
