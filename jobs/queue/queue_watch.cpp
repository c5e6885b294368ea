// Monitoring of a queue: obstacle, disk and progress.
#include "base/log/log.h"
#include "jobs/queue/queue.h"

namespace lacuna {

std::string Queue::obstacle() const {
  if (std::string shortage = disk_.shortage(); !shortage.empty()) return shortage;
  const Counts counts = store_.counts();
  if (unfinished_of(counts) == 0) return {};
  if (std::string why = executor_.obstacle(); !why.empty()) return why;
  const std::lock_guard lock(faults_mutex_);
  return faults_ > 0 ? obstacle_ : "";
}

void Queue::look_at_disk() {
  const bool low = disk_.is_low();
  const std::lock_guard lock(mutex_);
  for (const auto& [id, work] : work_) {
    if (low) work->stop.request();
  }
  changed_.notify_all();
}

void Queue::update_live(Work& work, const std::function<void(LiveState&)>& change) {
  LiveState live;
  {
    const std::lock_guard lock(mutex_);
    change(work.live);
    live = work.live;
  }
  store_.set_live(work.id, live);
}

void Queue::look_at_running() {
  std::vector<WorkPtr> running;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [id, work] : work_) running.push_back(work);
  }
  for (const WorkPtr& work : running) {
    try {
      look_at(*work);
    } catch (const std::exception& error) {  // its runner reports it
      log::debug("{}: {}", work->id, error.what());
    }
  }
}

/// Reads the progress of a renderer.
void Queue::look_at(Work& work) {
  const JobFolder job = folder(work.id);
  const auto progress = job.read_progress();
  const JobState said = job.read_state();
  if (said.state != State::running) return;
  const bool pictured = has_picture(job);
  update_live(work, [&](LiveState& live) {
    live.phase = said.phase;
    live.warnings = said.warnings;
    live.progress = progress;
    live.pictured = pictured;
  });
  // The start of a remote renderer is not reported.
  if (!executor_.is_remote()) return;
  store_.change([&](StoreChange& c) {
    auto entry = c.find_job(work.id);
    if (!entry || !entry->begun || entry->over()) return;
    entry->state.attempts = said.attempts;
    entry->state.started = said.started;
    if (entry->state.state == State::queued) entry->state.state = State::running;
    c.put(std::move(*entry));
  });
}

}  // namespace lacuna
