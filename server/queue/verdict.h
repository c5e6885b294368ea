#pragma once

#include <cstdint>
#include <string>

#include "jobs/store/state.h"
#include "server/queue/executor.h"

namespace lacuna {

/// The state of a job that is over, of one that waits (again), and of one that is held.
JobState ended(JobState state, State how, const std::string& now);
JobState queued(JobState state);
JobState held(JobState state);

/// What is known when a renderer has ended.
struct Attempt {
  JobState before;  ///< state.json before it was started
  JobState after;   ///< and after it has ended
  Ending ending;
  bool cancel = false;    ///< somebody asked to stop it for good
  bool hold = false;      ///< somebody asked to stop it until it is released
  bool stopped = false;   ///< the service asked it to stop, because it ends itself
  bool disk_low = false;  ///< free space is below the floor: nothing is the renderer's fault
  int crashes = 0;        ///< of this job's earlier renderers
  /// progress.json's iteration before it was started and after it has ended; 0: there is none
  std::int64_t iteration_before = 0, iteration_after = 0;
};

/// Where the job stands now.
struct Verdict {
  JobState state;  ///< terminal, held, or queued again
  bool crashed = false;
  std::string obstacle = {};  ///< what it waits to pass; empty: nothing
};

/// Judges an ended renderer (the contract of `lacuna render`: 0 done, 2 bad job, 3 scene or asset,
/// 71 out of memory, 75 interrupted and resumable, all else a crash). A terminal state that the
/// renderer wrote stands. A crash, want of memory and an interruption that nobody asked for and
/// that brought no iteration are retried from the checkpoint until there were `max_attempts` of
/// them; while the disk is low they are retried without being counted. A renderer that could not be
/// started, or could not write its files, for a reason that may pass is retried without being
/// counted, however often: it is not its fault.
Verdict judge(const Attempt& attempt, int max_attempts, const std::string& now);

}  // namespace lacuna
