#pragma once

#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "server/settings/queue_settings.h"
#include "server/tables/job_table.h"

namespace lacuna {

/// The jobs that `settings` say need not be kept, oldest first: over, not damaged, and no other
/// job's reference, no run of a sweep that is not over (`unfinished_sweeps`). `jobs` are all there
/// are, oldest first; `now` is UTC as JobState has it.
std::vector<std::string> outdated(const std::vector<EntryPtr>& jobs,
                                  const std::set<std::string>& unfinished_sweeps,
                                  const CareSettings& settings,
                                  std::chrono::system_clock::time_point now);

}  // namespace lacuna
