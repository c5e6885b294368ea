#pragma once

#include "jobs/store/job_folder.h"
#include "server/routes/posting.h"
#include "server/sweeps/sweep_keeper.h"
#include "server/tables/job_table.h"
#include "server/tables/sweep_table.h"

namespace lacuna {

/// Takes new sweeps. All references outlive it.
class SweepPosting final : public Posting {
 public:
  SweepPosting(const ScenesRoots& scenes, SweepTable& sweeps, const JobTable& jobs,
               SweepKeeper& keeper);

  /// The same checks as of post(), but nothing is stored: 200 with what the sweep comes to.
  Response dry_run(const Request& request) const;

 private:
  SweepPlan checked_plan(const std::string& body, SweepSpec& spec) const;
  /// Throws HttpError 400, with pointers into the sweep file, and 507.
  std::string make(const std::string& body, const Key& key) override;
  StoredKeys stored_keys() const override;
  std::optional<std::string> body_hash(const std::string& id) const override;
  OrderedJson describe_made(const std::string& id) const override;

  const ScenesRoots& scenes_;
  SweepTable& sweeps_;
  const JobTable& jobs_;
  SweepKeeper& keeper_;
};

}  // namespace lacuna
