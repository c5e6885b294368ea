#pragma once

#include "jobs/queue/store.h"
#include "server/routes/entry_json.h"

namespace lacuna {

/// The job with this id; throws HttpError 404.
JobEntry find_job(const Store& store, const std::string& id);

/// Number of jobs in each state: {"queued": 2, ...}.
OrderedJson counts_json(const Counts& counts);

/// A page of the list: {"jobs", "total", "counts", "next", "last_event"}.
OrderedJson list_json(const JobPage& page);

/// One job: {id, sweep, job, state, progress, priority, held, files}.
OrderedJson job_detail(const JobFolder& folder, const JobEntry& entry);

}  // namespace lacuna
