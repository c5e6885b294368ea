#pragma once

#include <string>

#include "server/tables/entry_json.h"
#include "server/tables/job_table.h"

namespace lacuna {

/// The entry of a job that is there, on disk too; throws HttpError 404.
EntryPtr find_job(JobTable& table, const std::string& id);

/// How many jobs there are in each state: {"queued": 2, ...}.
OrderedJson counts_json(const JobTable::Counts& counts);

/// A page of the list as JSON text: {"jobs", "total", "counts", "next", "last_event"}. Made from
/// the entries' texts: a list of a thousand jobs costs little more than copying them.
std::string list_text(const JobTable::Page& page);

/// One job: {id, sweep, job, state, progress, priority, held, files}.
OrderedJson job_detail(const JobTable& table, const JobEntry& entry);

}  // namespace lacuna
