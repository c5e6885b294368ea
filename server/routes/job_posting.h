#pragma once

#include "jobs/store/job_folder.h"
#include "server/queue/queue.h"
#include "server/routes/posting.h"
#include "server/sweeps/sweep_keeper.h"
#include "server/tables/job_table.h"
#include "server/tables/sweep_table.h"

namespace lacuna {

/// Takes new jobs. A job with shards becomes a job that waits, and a sweep whose runs are these; it
/// is merged when they are rendered. All references outlive it.
class JobPosting final : public Posting {
 public:
  JobPosting(DataRoot data, const ScenesRoots& scenes, JobTable& table, Queue& queue,
             SweepTable& sweeps, SweepKeeper& keeper);

  /// The same checks as of post(), but nothing is stored: 200 with the job and its defaults.
  Response dry_run(const Request& request) const;

 private:
  JobSpec checked_spec(const std::string& body) const;
  std::string new_id() const;
  JobFolder create(const JobSpec& spec, JobControl control);
  /// Throws HttpError 400, 429 (too many wait), 507.
  std::string make(const std::string& body, const Key& key) override;
  StoredKeys stored_keys() const override;
  std::optional<std::string> body_hash(const std::string& id) const override;
  OrderedJson describe_made(const std::string& id) const override;

  const DataRoot data_;
  const ScenesRoots& scenes_;
  JobTable& table_;
  Queue& queue_;
  SweepTable& sweeps_;
  SweepKeeper& keeper_;
};

}  // namespace lacuna
