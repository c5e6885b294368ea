// The threads that have jobs rendered.

#include <algorithm>
#include <csignal>
#include <system_error>
#include <utility>

#include "analysis/storage/passing_error.h"
#include "server/queue/child_process.h"
#include "server/queue/process_identity.h"
#include "server/queue/queue.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

// How often a folder that another renderer holds is looked at again.
constexpr std::chrono::milliseconds look_again_at_lock{200};
// How often it is looked whether the shards of a job are over.
constexpr std::chrono::seconds look_again_at_shards{1};

// What brought a job down may pass. A crash may be the job's own doing; a fault that passes shall
// not be waited for much longer than it lasts, least of all by the whole queue.
constexpr std::chrono::minutes longest_after_crash{1};
constexpr std::chrono::seconds longest_after_fault{30}, longest_pause{5};

/// What of an error concerns everybody: without the names of files.
std::string general_reason(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return system != nullptr ? system->code().message() : error.what();
}

ProcessIdentity renderer_of(const JobControl& control) {
  return {static_cast<pid_t>(control.renderer_pid),
          static_cast<std::uint64_t>(control.renderer_start), control.renderer_boot};
}

}  // namespace

/// The job's folder for ourselves; nothing while a renderer has it, or may be about to take it.
/// Only under the fork mutex.
std::optional<JobFolder::Lock> Queue::try_folder(const Work& work) const {
  const ProcessIdentity renderer = renderer_of(work.control);
  if (renderer.pid > 0 && is_alive(renderer)) return std::nullopt;
  if (executor_.holds(table_.folder(work.id))) return std::nullopt;
  return table_.folder(work.id).try_lock();
}

void Queue::run(const std::stop_token& ends) {
  while (const WorkPtr work = take(ends)) {
    try {
      attend(*work, ends);
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      if (may_pass(error)) {
        postpone(*work, error);
      } else {
        give_up(work->id, error.what());
      }
    }
    const std::lock_guard lock(mutex_);
    hand_back(work);
  }
}

/// Only under the lock, as all that follows to first_ready().
void Queue::hand_back(const WorkPtr& work) {
  work->stop.reset();
  --running_;
  exclusive_runs_ = false;
  changed_.notify_all();
  // Not one that was retried meanwhile: that is another work.
  const auto left = work_.find(work->id);
  if (left == work_.end() || left->second != work) return;
  try {
    resume(*work);
  } catch (const std::exception& error) {
    if (!may_pass(error)) return give_up(work->id, error.what());
    postpone(*work, error);
    line_up(*work);
  }
}

/// A fault that may pass keeps the job from going on.
void Queue::postpone(Work& work, const std::exception& error) {
  note_obstacle(work, error.what(), general_reason(error));
  const EntryPtr entry = table_.find(work.id);
  const bool ran =
      entry && (entry->state.state == State::running || entry->state.state == State::interrupted);
  if (ran) table_.set_state(work.id, queued(entry->state), false);
}

/// The next job is tried after a pause, and this one later still: what keeps one folder from being
/// used may leave the others alone. `for_all`: `what` without the names of files.
void Queue::note_obstacle(Work& work, const std::string& what, const std::string& for_all) {
  paused_until_ = Clock::now() + pause_after_fault(++faults_, longest_pause);
  work.not_before = paused_until_ + pause_after_fault(++work.faults, longest_after_fault);
  if (obstacle_ != for_all) log::warn("jobs wait: {}", what);
  obstacle_ = for_all;
  table_.set_obstacle(work.id, what);
}

/// The job's folder is damaged, or is not there any more.
void Queue::give_up(const std::string& id, const std::string& reason) {
  log::error("{} is given up: {}", id, reason);
  forget(id);
  if (is_gone(table_.folder(id).dir())) return table_.remove(id);
  if (const EntryPtr entry = table_.find(id)) {
    JobState state = ended(entry->state, State::failed, utc_now());
    state.error = reason;
    table_.set_state(id, state, true);
  }
}

std::string Queue::obstacle() const {
  if (std::string shortage = disk_.shortage(); !shortage.empty()) return shortage;
  const std::lock_guard lock(mutex_);
  if (std::string why = executor_.obstacle(); !why.empty() && !work_.empty()) return why;
  if (faults_ > 0 && !line_.empty()) return obstacle_;
  return unsaved_.empty() ? "" : "states of jobs that have ended cannot be saved";
}

/// The first in the line that may start now; `look_again` is when time alone may change that.
Queue::WorkPtr Queue::first_ready(Clock::time_point& look_again) const {
  if (line_.empty() || exclusive_runs_ || disk_.is_low()) return nullptr;
  const auto now = Clock::now();
  if (paused_until_ > now) {
    look_again = paused_until_;
    return nullptr;
  }
  for (const QueueKey& key : line_) {
    const WorkPtr& work = work_.at(std::get<3>(key));
    if (work->not_before > now) {
      look_again = std::min(look_again, work->not_before);
    } else if (waits_for_shards(*work)) {
      look_again = std::min(look_again, now + look_again_at_shards);
    } else {
      return work->exclusive && running_ > 0 ? nullptr : work;
    }
  }
  return nullptr;
}

/// A job is merged once its shards are rendered; one with a checkpoint was merged before.
bool Queue::waits_for_shards(const Work& work) const {
  if (work.control.shards.empty()) return false;
  const EntryPtr entry = table_.find(work.id);
  if (!entry || !table_.waits_for_shards(*entry)) return false;
  std::error_code unknown;  // it waits until that can be told
  return !std::filesystem::exists(table_.folder(work.id).file("checkpoint.bin"), unknown);
}

Queue::WorkPtr Queue::take(const std::stop_token& ends) {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (ends.stop_requested()) return nullptr;
    auto look_again = Clock::now() + std::chrono::hours(1);
    if (WorkPtr work = first_ready(look_again)) {
      try {
        work->stop = std::make_shared<StopSignal>();
      } catch (const std::exception& error) {  // no descriptor is left for it
        postpone(*work, error);
        continue;
      }
      leave_line(*work);
      ++running_;
      exclusive_runs_ = work->exclusive;
      return work;
    }
    changed_.wait_until(lock, look_again);
  }
}

/// Waits while somebody else's renderer has the folder; one that an earlier run of this service
/// started has had its notice to stop and is killed after the grace. False: stop was asked for.
bool Queue::wait_until_free(const Work& work, const std::stop_token& ends) {
  const auto is_free = [&] {
    const std::lock_guard no_forks(fork_mutex());
    return try_folder(work).has_value();
  };
  const auto patience = Clock::now() + settings_.grace;
  bool killed = false;
  while (!is_free()) {
    if (!killed && Clock::now() >= patience) {
      killed = kill_group(renderer_of(work.control), SIGKILL);
      if (killed) log::warn("{}: an earlier renderer did not end and is killed", work.id);
    }
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, look_again_at_lock, [&] { return ends.stop_requested(); })) {
      return false;
    }
  }
  return true;
}

/// A job whose folder could not be read when it came in.
void Queue::read_at_last(const std::string& id) {
  const EntryPtr entry = table_.reread(id);
  {
    const std::lock_guard lock(mutex_);
    work_.erase(id);
  }
  if (entry) enter(id);
}

void Queue::attend(Work& work, const std::stop_token& ends) {
  if (const EntryPtr entry = table_.find(work.id); entry && entry->unread) {
    return read_at_last(work.id);
  }
  const JobFolder folder = table_.folder(work.id);
  if (!executor_.holds(folder) && !wait_until_free(work, ends)) return;
  if (!work.ended && !render(work)) return;
  try {
    work.ended->after = folder.read_state();
  } catch (const std::runtime_error& error) {
    if (may_pass(error)) throw;  // the renderer is judged when that can be read
    log::error("{}: {}", work.id, error.what());
    work.ended->after = work.ended->before;
  }
  Attempt attempt = *std::exchange(work.ended, std::nullopt);
  settle(work, std::move(attempt), ends);
}

/// Notes what is known before the renderer starts. False: somebody has asked for something else, or
/// the job is over.
bool Queue::may_render(Work& work, Attempt& attempt) {
  const JobFolder folder = table_.folder(work.id);
  const std::lock_guard lock(mutex_);
  attempt.found = executor_.holds(folder);
  if (attempt.found) {
    if (work.control.cancel || work.control.held) work.stop->request();
  } else {
    if (work.control.cancel) return withdraw(work, State::cancelled), false;
    if (work.control.held) return withdraw(work, State::held), false;
  }
  attempt.before = stored_state(work.id);
  attempt.crashes = work.control.crashes;
  if (const auto progress = folder.read_progress()) attempt.iteration_before = progress->iteration;
  // A renderer of an earlier service came to the end.
  if (!attempt.found && is_terminal(attempt.before.state)) {
    table_.set_state(work.id, attempt.before, true);
    return forget(work.id), false;
  }
  return true;
}

/// Has the job rendered. False: it is not to be, or its renderer goes on without this service.
bool Queue::render(Work& work) {
  Attempt attempt;
  if (!may_render(work, attempt)) return false;
  table_.set_place(work.id, "");
  log::info("{}: {}", work.id,
            attempt.found ? "its renderer is found again" : "a renderer is started");
  attempt.ending =
      executor_.run(table_.folder(work.id), *work.stop,
                    {.started = [&](pid_t pid) { note_start(work, pid); },
                     .place = [&](const std::string& place) { table_.set_place(work.id, place); }});
  log::info("{}: {}", work.id, attempt.ending.reason);
  if (attempt.ending.kind == Ending::Kind::left) return false;
  table_.set_place(work.id, "");
  work.ended = std::move(attempt);
  return true;
}

/// A renderer has begun: no fault keeps the queue from going on any more. It is noted so that it is
/// known again after a restart, should it outlive the service.
void Queue::note_start(Work& work, pid_t pid) {
  const auto identity = identity_of(pid);
  const std::lock_guard lock(mutex_);
  table_.set_obstacle(work.id, "");
  work.faults_of_all = std::exchange(faults_, 0);
  if (work.faults_of_all > 1) {  // which not one folder alone had
    for (const auto& [id, other] : work_) {
      if (other->faults > 0) other->not_before = {};
    }
  }
  if (!identity) return;
  JobControl control = work.control;
  control.renderer_pid = identity->pid;
  control.renderer_start = static_cast<std::int64_t>(identity->start_ticks);
  control.renderer_boot = identity->boot;
  try {
    write_control(work, control);
  } catch (const std::exception& error) {
    log::warn("{}: {}", work.id, error.what());
  }
}

void Queue::settle(Work& work, Attempt attempt, const std::stop_token& ends) {
  const auto progress = table_.folder(work.id).read_progress();
  if (progress) attempt.iteration_after = progress->iteration;
  const std::lock_guard lock(mutex_);
  attempt.cancel = work.control.cancel;
  attempt.hold = work.control.held;
  attempt.stopped = ends.stop_requested() || work.stopped_for_disk;
  attempt.disk_low = disk_.is_low();
  const ExitClassification exit = classify_exit(attempt, settings_.max_attempts, utc_now());
  if (progress) table_.set_progress(work.id, *progress);
  if (exit.crashed) {
    JobControl control = work.control;
    ++control.crashes;
    try {
      write_control(work, control);
    } catch (const std::exception& error) {
      log::warn("{}: {}", work.id, error.what());
      work.control = control;
    }
    work.not_before = Clock::now() + pause_after_fault(control.crashes, longest_after_crash);
  }
  const bool came_on = attempt.iteration_after > attempt.iteration_before;
  if (exit.obstacle.empty() || came_on) work.faults = 0;
  if (!exit.obstacle.empty()) {  // before the state: who sees that the job waits also sees why
    if (!came_on) faults_ = std::max(faults_, work.faults_of_all);  // it began in vain
    note_obstacle(work, exit.obstacle, "renderers cannot be started or cannot use their files");
  }
  const bool over = is_terminal(exit.state.state);
  write_state(work.id, exit.state, over);
  if (over) forget(work.id);
}

/// A job that a runner gives back and that is not over: waits again, unless it is held.
void Queue::resume(Work& work) {
  work.stopped_for_disk = false;
  const EntryPtr entry = table_.find(work.id);
  if (!entry) return forget(work.id);
  if (work.control.cancel) {  // asked for after its renderer had been classified
    if (withdraw(work, State::cancelled)) return;
  } else if (work.control.held) {
    if (entry->state.state == State::held || withdraw(work, State::held)) return;
  } else if (entry->state.state == State::held) {  // released after that
    withdraw(work, State::queued);
  }
  line_up(work);
}

}  // namespace lacuna
