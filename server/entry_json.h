#pragma once

#include "jobs/spec/json_text.h"
#include "jobs/store/job_folder.h"
#include "server/job_table.h"

namespace lacuna {

OrderedJson to_json(const JobState& state);
OrderedJson to_json(const Progress& progress);
/// As an element of the API's list of jobs.
OrderedJson to_json(const JobEntry& entry);

}  // namespace lacuna
