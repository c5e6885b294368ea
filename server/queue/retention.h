#pragma once

#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "server/settings/queue_settings.h"
#include "server/tables/job_table.h"

namespace lacuna {

/// The jobs that may be removed by `settings`, oldest first: over, not damaged, not the reference
/// of another job, and not a run of an unfinished sweep (`unfinished_sweeps`); none as long as one
/// is `unread`. `jobs`: all jobs, oldest first; `now`: UTC as in JobState.
std::vector<std::string> outdated(const std::vector<EntryPtr>& jobs,
                                  const std::set<std::string>& unfinished_sweeps,
                                  const CareSettings& settings,
                                  std::chrono::system_clock::time_point now);

}  // namespace lacuna
