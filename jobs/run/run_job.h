#pragma once

#include <functional>
#include <optional>

#include "jobs/run/merge_shards.h"
#include "jobs/run/observer.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// The environment of a job.
struct RunContext {
  DataRoot data;
  ScenesRoots scenes;
  int threads = -1;                          ///< >= 0: overrides the job's own
  const std::function<bool()>& interrupted;  ///< true requests a stop; called from any thread
  Observer& observer;
  const std::vector<Shard>* shards = nullptr;  ///< the job is merged from these, not rendered
  std::function<double()> seconds_left = {};   ///< see RenderTask
  std::filesystem::path trace = {};  ///< file for the work of all threads (WorkLog); empty: none
};

enum class Outcome { done, interrupted };

/// Another process has the folder's lock.
class FolderBusy : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Renders the job of `folder`, from its checkpoint if there is one, or from the shards that a
/// service has rendered for it. outcome.json becomes `running`, then `done`, `interrupted`, or
/// `failed` with the reason, and the exception is rethrown: BadJob, SceneError and others. A
/// transient error (Obstacle) leaves the job `interrupted` with the reason, if the state can be
/// written, and is rethrown, too. Does nothing for a job that is done. Throws FolderBusy.
///
/// The input files of a job are recorded in inputs.json. Throws BadJob if they have changed since
/// the job's checkpoint or end (InputCheck); an existing result is kept.
Outcome run_job(const JobFolder& folder, const RunContext& context);

}  // namespace lacuna
