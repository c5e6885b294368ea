#pragma once

#include "analysis/json/json_text.h"
#include "jobs/store/job_folder.h"
#include "server/tables/job_entry.h"

namespace lacuna {

OrderedJson to_json(const JobState& state);
OrderedJson to_json(const Progress& progress);
/// The id of its sweep, or null.
OrderedJson sweep_json(const JobEntry& entry);
/// Its state, and the obstacle that keeps it from going on.
OrderedJson state_json(const JobEntry& entry);
/// As an element of the API's list of jobs.
OrderedJson to_json(const JobEntry& entry);

}  // namespace lacuna
