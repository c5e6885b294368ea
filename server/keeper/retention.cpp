#include "server/keeper/retention.h"

#include <algorithm>

namespace lacuna {

std::vector<std::string> outdated(const std::vector<JobEntry>& removable,
                                  const CareSettings& settings,
                                  std::chrono::system_clock::time_point now) {
  const std::size_t surplus = settings.keep_jobs > 0 && removable.size() > settings.keep_jobs
                                  ? removable.size() - settings.keep_jobs
                                  : 0;
  const auto age = std::chrono::duration_cast<std::chrono::system_clock::duration>(
      std::chrono::duration<double, std::ratio<86400>>(settings.keep_days));
  const std::string too_old = utc_text(now - age);
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < removable.size(); ++i) {
    // The clock of the rendering machine may be behind.
    const JobState& state = removable[i].state;
    const bool old = settings.keep_days > 0 && std::max(state.finished, state.created) < too_old;
    if (i < surplus || old) ids.push_back(removable[i].id);
  }
  return ids;
}

}  // namespace lacuna
