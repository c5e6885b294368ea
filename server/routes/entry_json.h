#pragma once

#include "base/json/json_text.h"
#include "jobs/queue/job_entry.h"

namespace lacuna {

OrderedJson to_json(const Progress& progress);
/// State, transient obstacle, and the place where it runs or waits.
OrderedJson state_json(const JobEntry& entry);
/// As an element of the API's list of jobs.
OrderedJson to_json(const JobEntry& entry);
/// A text; null if it is empty.
OrderedJson or_null(const std::string& text);

}  // namespace lacuna
