#pragma once

#include "jobs/queue/store.h"
#include "server/keeper/sweep_folders.h"
#include "server/keeper/sweep_keeper.h"
#include "server/routes/posting.h"

namespace lacuna {

/// Accepts new sweeps. All references must outlive it.
class SweepPosting {
 public:
  SweepPosting(const ScenesRoots& scenes, Store& store, SweepFolders& folders, SweepKeeper& keeper)
      : scenes_(scenes), store_(store), folders_(folders), keeper_(keeper) {}

  /// 201 with the sweep, once it is stored; 200 with the one created before by the same
  /// Idempotency-Key and body. Throws HttpError 400, with pointers into the sweep file, 415, 422
  /// and 507.
  Response post(const Request& request);
  /// The same checks without storing: 200 with the plan of the sweep.
  Response dry_run(const Request& request) const;

 private:
  SweepPlan checked_plan(const std::string& body, SweepSpec& spec) const;

  const ScenesRoots& scenes_;
  Store& store_;
  SweepFolders& folders_;
  SweepKeeper& keeper_;
};

}  // namespace lacuna
