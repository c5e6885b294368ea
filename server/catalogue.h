#pragma once

#include <map>
#include <mutex>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "jobs/store/job_folder.h"
#include "server/queue.h"

namespace lacuna {

using Json = nlohmann::ordered_json;

Json to_json(const JobState& state);
Json to_json(const Progress& progress);

/// Jobs as the API shows them, read from their folders.
class Catalogue {
 public:
  Catalogue(DataRoot data, const Queue& queue) : data_(std::move(data)), queue_(queue) {}

  /// The job's folder; throws HttpError 404 if there is no such job.
  JobFolder find(const std::string& id) const;
  /// All jobs, newest first: {"jobs": [{id, label, scene, integrator, state, progress, ...}]}.
  Json list() const;
  /// One job: {id, job, state, progress, files}.
  Json detail(const JobFolder& folder) const;

 private:
  /// What never changes once it is known: a job file, and the state of a job that is over.
  struct Known {
    std::string label, scene, integrator;
    bool over = false;
    JobState state;
    std::optional<Progress> progress;
  };
  Known known(const JobFolder& folder) const;

  const DataRoot data_;
  const Queue& queue_;
  mutable std::mutex mutex_;  // guards known_ only
  mutable std::map<std::string, Known> known_;
};

}  // namespace lacuna
