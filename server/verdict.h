#pragma once

#include <string>

#include "jobs/store/state.h"
#include "server/executor.h"

namespace lacuna {

/// The state of a job that is over, and of one that waits (again).
JobState ended(JobState state, State how, const std::string& now);
JobState queued(JobState state);

/// What is known when a renderer has ended.
struct Attempt {
  JobState before;  ///< state.json before it was started
  JobState after;   ///< and after it has ended
  Ending ending;
  bool cancel = false;   ///< somebody asked to stop it for good
  bool stopped = false;  ///< the service asked it to stop, because it ends itself
  int crashes = 0;       ///< of this job's earlier renderers
};

/// Where the job stands now.
struct Verdict {
  JobState state;  ///< terminal, or queued again
  bool crashed = false;
};

/// Judges an ended renderer (the contract of `lacuna render`: 0 done, 2 bad job, 3 scene or asset,
/// 75 interrupted and resumable, all else a crash). A terminal state that the renderer wrote
/// stands; a crash is retried from the checkpoint until there were `max_attempts` of them.
Verdict judge(const Attempt& attempt, int max_attempts, const std::string& now);

}  // namespace lacuna
