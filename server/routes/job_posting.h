#pragma once

#include "jobs/queue/queue.h"
#include "jobs/queue/store.h"
#include "server/keeper/sweep_keeper.h"
#include "server/routes/posting.h"

namespace lacuna {

/// Accepts new jobs. A job with shards becomes a waiting job and a sweep whose runs are the shards;
/// it is merged when they are rendered. All references must outlive it.
class JobPosting {
 public:
  JobPosting(const ScenesRoots& scenes, Store& store, Queue& queue, SweepKeeper& keeper)
      : scenes_(scenes), store_(store), queue_(queue), keeper_(keeper) {}

  /// 201 with the job, once it is stored; 200 with the one created before by the same
  /// Idempotency-Key and body. Throws HttpError 400, 415, 422 (the key was used with another body),
  /// 429 (too many jobs), 507.
  Response post(const Request& request);
  /// The same checks without storing: 200 with the job and its defaults.
  Response dry_run(const Request& request) const;

 private:
  JobSpec checked_spec(const std::string& body) const;
  std::optional<SweepEntry> sweep_of_shards(const JobSpec& spec) const;

  const ScenesRoots& scenes_;
  Store& store_;
  Queue& queue_;
  SweepKeeper& keeper_;
};

}  // namespace lacuna
