#include "server/queue/retention.h"

#include <algorithm>
#include <set>

namespace lacuna {

std::vector<std::string> outdated(const std::vector<EntryPtr>& jobs,
                                  const std::set<std::string>& unfinished_sweeps,
                                  const CareSettings& settings,
                                  std::chrono::system_clock::time_point now) {
  if (settings.keep_jobs == 0 && settings.keep_days == 0) return {};
  std::set<std::string> referenced;
  for (const EntryPtr& job : jobs) referenced.insert(job->reference);
  std::vector<EntryPtr> over;
  for (const EntryPtr& job : jobs) {
    if (job->unread) return {};  // nobody knows which others it needs
    const bool wanted = referenced.contains(job->id) || unfinished_sweeps.contains(job->sweep);
    if (job->over && !job->damaged && !wanted) over.push_back(job);
  }
  const std::size_t surplus = settings.keep_jobs > 0 && over.size() > settings.keep_jobs
                                  ? over.size() - settings.keep_jobs
                                  : 0;
  const auto age = std::chrono::duration_cast<std::chrono::system_clock::duration>(
      std::chrono::duration<double, std::ratio<86400>>(settings.keep_days));
  const std::string too_old = utc_text(now - age);
  std::vector<std::string> ids;
  for (std::size_t i = 0; i < over.size(); ++i) {
    // The clock of the machine that rendered it may be behind.
    const JobState& state = over[i]->state;
    const bool old = settings.keep_days > 0 && std::max(state.finished, state.created) < too_old;
    if (i < surplus || old) ids.push_back(over[i]->id);
  }
  return ids;
}

}  // namespace lacuna
