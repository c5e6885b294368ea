#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "jobs/queue/job_entry.h"
#include "server/settings/care_settings.h"

namespace lacuna {

/// The `removable` jobs (Store::removable()) that `settings` do not keep, oldest first. `now`: UTC.
std::vector<std::string> outdated(const std::vector<JobEntry>& removable,
                                  const CareSettings& settings,
                                  std::chrono::system_clock::time_point now);

}  // namespace lacuna
