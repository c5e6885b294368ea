#pragma once

#include "jobs/queue/store.h"
#include "server/keeper/sweep_folders.h"
#include "server/keeper/sweep_keeper.h"
#include "server/routes/posting.h"

namespace lacuna {

/// Takes new sweeps. All references outlive it.
class SweepPosting {
 public:
  SweepPosting(const ScenesRoots& scenes, Store& store, SweepFolders& folders, SweepKeeper& keeper)
      : scenes_(scenes), store_(store), folders_(folders), keeper_(keeper) {}

  /// 201 with the sweep, once it is stored; 200 with the one that the same Idempotency-Key and body
  /// have made before. Throws HttpError 400, with pointers into the sweep file, 415, 422 and 507.
  Response post(const Request& request);
  /// The same checks, but nothing is stored: 200 with what the sweep comes to.
  Response dry_run(const Request& request) const;

 private:
  SweepPlan checked_plan(const std::string& body, SweepSpec& spec) const;

  const ScenesRoots& scenes_;
  Store& store_;
  SweepFolders& folders_;
  SweepKeeper& keeper_;
};

}  // namespace lacuna
