#pragma once

#include <functional>
#include <optional>

#include "jobs/run/merge_shards.h"
#include "jobs/run/observer.h"
#include "jobs/store/job_folder.h"

namespace lacuna {

/// What surrounds a job.
struct RunContext {
  DataRoot data;
  ScenesRoots scenes;
  int threads = -1;                          ///< >= 0: in place of the job's own
  const std::function<bool()>& interrupted;  ///< true asks to stop soon, from any thread
  Observer& observer;
  const std::vector<Shard>* shards = nullptr;  ///< the job is merged from these, not rendered
  std::function<double()> seconds_left = {};   ///< see RenderTask
};

enum class Outcome { done, interrupted };

/// The folder is another process's at present.
class FolderBusy : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Does the job of `folder`, from its checkpoint if there is one, or from the shards that a service
/// has had rendered for it: outcome.json becomes `running`,
/// then `done`, `interrupted`, or `failed` with the reason (and the exception goes on): BadJob,
/// SceneError and others. What another time may bring (see Obstacle) leaves the job `interrupted`
/// with the reason, if the state can be written at all, and the exception goes on, too. A job that
/// is done is left as it is. Throws FolderBusy.
///
/// What a job reads is recorded in inputs.json. A job that has a checkpoint, or is done, throws
/// BadJob if its inputs have changed since (InputCheck); then a result that is there stays.
Outcome run_job(const JobFolder& folder, const RunContext& context);

}  // namespace lacuna
