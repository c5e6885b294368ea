#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "jobs/store/job_folder.h"
#include "server/job_table.h"

namespace lacuna {

using Json = nlohmann::ordered_json;

/// One line of text; bytes that are no UTF-8 are replaced.
std::string json_text(const Json& json);

Json to_json(const JobState& state);
Json to_json(const Progress& progress);
/// As an element of the API's list of jobs.
Json to_json(const JobEntry& entry);

}  // namespace lacuna
