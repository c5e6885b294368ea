#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "jobs/queue/executor.h"
#include "jobs/queue/queue_settings.h"
#include "jobs/slurm/slurm_settings.h"
#include "jobs/slurm/slurm_watch.h"

namespace lacuna {

/// Submits each job to Slurm, after recording the submission in its folder, and waits until the
/// folder or Slurm reports the end. Renderers outlive the queue; the next queue finds them by the
/// recorded submissions.
class SlurmExecutor : public Executor {
 public:
  /// Throws std::invalid_argument if the renderer or a program of Slurm is missing. `run`: for
  /// tests; empty: programs in PATH.
  SlurmExecutor(ExecutorSettings settings, SlurmSettings slurm, RunProgram run = {});

  Ending run(const Task& task, const StopSignal& stop, const Notices& notices) override;
  bool is_remote() const override { return true; }
  bool holds(const JobFolder& folder) const override { return has_submission(folder); }
  void forget(const JobFolder& folder) override { forget_submission(folder); }
  void set_priority(const JobFolder& folder, int priority) override;
  std::string obstacle() const override;

 private:
  class Stopping;
  /// A submission, and the output of sbatch if it returned no number, or why it could not be
  /// called.
  struct Attempted {
    Submission submission;
    std::string said;
    bool called = true;
  };
  Attempted submit(const Task& task);
  Ending follow(const JobFolder& folder, Attempted attempted, const StopSignal& stop,
                const Notices& notices);
  void show_priority(const SlurmWatch::View& view) const;
  std::vector<std::string> words_for(const Task& task, const Submission& submission) const;

  const ExecutorSettings settings_;
  const SlurmSettings slurm_;
  const std::vector<std::string> environment_;
  const SlurmPrograms programs_;
  std::mutex submitting_;     // one sbatch at a time
  mutable std::mutex mutex_;  // guards the next
  std::string refusal_;       // output of the last failed sbatch; empty once one succeeds
  SlurmWatch watch_;
};

}  // namespace lacuna
