#pragma once

#include <cstdint>
#include <string>

#include "jobs/queue/executor.h"
#include "jobs/store/state.h"

namespace lacuna {

/// `state` as that of a job that is over (in the state `how`), queued again, or held.
JobState ended(JobState state, State how, const std::string& now);
JobState queued(JobState state);
JobState held(JobState state);

/// The circumstances in which a renderer ended.
struct Attempt {
  JobState before;  ///< the folder's state before the renderer started
  JobState after;   ///< and after it ended
  Ending ending;
  bool cancel = false;    ///< a client cancelled the job
  bool hold = false;      ///< a client put the job on hold
  bool stopped = false;   ///< the queue requested the renderer to stop
  bool disk_low = false;  ///< free space is below the floor, so failures do not count as crashes
  bool found = false;     ///< `before` was read after the renderer had started
  int crashes = 0;        ///< crashes of this job's earlier renderers
  /// Iteration in progress.json before the renderer started and after it ended; 0: none.
  std::int64_t iteration_before = 0, iteration_after = 0;
};

/// The job's next state, and whether the exit counts as a crash.
struct ExitClassification {
  JobState state;  ///< terminal, held, or queued again
  bool crashed = false;
  std::string obstacle = {};  ///< the transient obstacle that the job waits for; empty: none
};

/// Classifies the exit of a renderer by the exit codes of `lacuna render`: 0 done, 2 bad job, 3
/// scene or asset, 71 out of memory, 75 interrupted and resumable; all others are crashes. A
/// terminal state that the renderer wrote is kept. Crashes, lack of memory, and unrequested
/// interruptions without a completed iteration are retried from the checkpoint, up to
/// `max_attempts` times; while the disk is low they are retried without being counted. A renderer
/// that could not be started, never began (never_began()), or could not read or write its files for
/// a transient reason (may_pass()) is retried without being counted; a refused job fails. A lost
/// renderer counts as an unrequested interruption.
ExitClassification classify_exit(const Attempt& attempt, int max_attempts, const std::string& now);

}  // namespace lacuna
