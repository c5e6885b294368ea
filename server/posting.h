#pragma once

#include <map>
#include <mutex>
#include <string>

#include "jobs/store/job_folder.h"
#include "server/job_table.h"
#include "server/message.h"
#include "server/queue.h"

namespace lacuna {

/// Takes new jobs. All references outlive it.
class Posting {
 public:
  Posting(DataRoot data, const ScenesRoots& scenes, JobTable& table, Queue& queue)
      : data_(std::move(data)), scenes_(scenes), table_(table), queue_(queue) {}

  /// POST /api/jobs. 201 with the job, once its folder is on disk; 200 with the job that the same
  /// Idempotency-Key and body have made before, also before a restart. Throws HttpError: 400, 415,
  /// 422 (the key stands for another body), 429 (too many wait), 507.
  Response post(const Request& request);
  /// The same checks, but nothing is stored: 200 with the job and its defaults.
  Response dry_run(const Request& request) const;

 private:
  JobSpec checked_spec(const std::string& body) const;
  void check_files(const JobSpec& spec) const;
  Response replay(const std::string& id, const std::string& body_hash) const;
  Response create(const JobSpec& spec, const JobControl& control);
  void read_keys();

  const DataRoot data_;
  const ScenesRoots& scenes_;
  JobTable& table_;
  Queue& queue_;
  std::mutex mutex_;  // held while a job with a key is made: the same key twice at once is one job
  bool keys_read_ = false;
  std::map<std::string, std::string> keys_;  // Idempotency-Key -> job id
};

}  // namespace lacuna
