// The threads that have jobs rendered.

#include <algorithm>
#include <csignal>
#include <utility>

#include "server/queue/child_process.h"
#include "server/queue/process_identity.h"
#include "server/queue/queue.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

// How often a folder that another renderer holds is looked at again.
constexpr std::chrono::milliseconds look_again_at_lock{200};

/// The wait after the n-th crash of a job: what brought it down may pass.
std::chrono::milliseconds back_off(int crashes) {
  constexpr std::chrono::milliseconds first{250}, longest{60'000};
  return std::min(longest, first * (1 << std::min(crashes - 1, 10)));
}

ProcessIdentity renderer_of(const JobControl& control) {
  return {static_cast<pid_t>(control.renderer_pid),
          static_cast<std::uint64_t>(control.renderer_start)};
}

}  // namespace

/// The job's folder for ourselves; nothing while a renderer has it, or may be about to take it.
/// Only under the fork mutex.
std::optional<JobFolder::Lock> Queue::try_folder(const Work& work) const {
  const ProcessIdentity renderer = renderer_of(work.control);
  if (renderer.pid > 0 && is_alive(renderer)) return std::nullopt;
  return table_.folder(work.id).try_lock();
}

void Queue::run() {
  while (const WorkPtr work = take()) {
    try {
      attend(*work);
    } catch (const std::exception& error) {
      give_up(work->id, error.what());
    }
    const std::lock_guard lock(mutex_);
    work->stop.reset();
    --running_;
    exclusive_runs_ = false;
    // Not one that was retried meanwhile: that is another work.
    if (const auto left = work_.find(work->id); left != work_.end() && left->second == work) {
      resume(*work);
    }
    changed_.notify_all();
  }
}

/// The job's folder cannot be read or written any more.
void Queue::give_up(const std::string& id, const std::string& reason) {
  log::error("{} is given up: {}", id, reason);
  const std::lock_guard lock(mutex_);
  forget(id);
  std::error_code ignored;
  if (!std::filesystem::exists(table_.folder(id).dir(), ignored)) {
    return table_.remove(id);
  }
  if (const EntryPtr entry = table_.find(id)) {
    JobState state = ended(entry->state, State::failed, utc_now());
    state.error = reason;
    table_.set_state(id, state, true);
  }
}

/// The first in the line that may start now; `look_again` is when time alone may change that.
Queue::WorkPtr Queue::first_ready(Clock::time_point& look_again) const {
  if (line_.empty() || exclusive_runs_ || disk_.is_low()) return nullptr;
  const auto now = Clock::now();
  for (const QueueKey& key : line_) {
    const WorkPtr& work = work_.at(std::get<2>(key));
    if (work->not_before > now) {
      look_again = std::min(look_again, work->not_before);
    } else {
      return work->exclusive && running_ > 0 ? nullptr : work;
    }
  }
  return nullptr;
}

Queue::WorkPtr Queue::take() {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (stopping_) return nullptr;
    auto look_again = Clock::now() + std::chrono::hours(1);
    if (WorkPtr work = first_ready(look_again)) {
      leave_line(*work);
      work->stop = std::make_shared<StopSignal>();
      ++running_;
      exclusive_runs_ = work->exclusive;
      return work;
    }
    changed_.wait_until(lock, look_again);
  }
}

/// Waits while somebody else's renderer has the folder; one that an earlier run of this service
/// started has had its notice to stop and is killed after the grace. False: stop was asked for.
bool Queue::wait_until_free(const Work& work) {
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
    if (changed_.wait_for(lock, look_again_at_lock, [&] { return stopping_; })) return false;
  }
  return true;
}

void Queue::attend(Work& work) {
  if (!wait_until_free(work)) return;
  const JobFolder folder = table_.folder(work.id);
  Attempt attempt;
  {
    const std::lock_guard lock(mutex_);
    if (work.control.cancel) return void(withdraw(work, State::cancelled));
    if (work.control.held) return void(withdraw(work, State::held));
    attempt.before = stored_state(work.id);
    attempt.crashes = work.control.crashes;
    if (const auto progress = folder.read_progress()) {
      attempt.iteration_before = progress->iteration;
    }
    if (is_terminal(attempt.before.state)) {  // a renderer of an earlier service came to the end
      table_.set_state(work.id, attempt.before, true);
      return forget(work.id);
    }
  }
  log::info("{}: a renderer is started", work.id);
  attempt.ending = executor_.run(folder, *work.stop, [&](pid_t pid) { note_renderer(work, pid); });
  log::info("{}: {}", work.id, attempt.ending.reason);
  try {
    attempt.after = folder.read_state();
  } catch (const std::runtime_error& error) {
    log::error("{}: {}", work.id, error.what());
    attempt.after = attempt.before;
  }
  settle(work, std::move(attempt));
}

/// So that a renderer that outlives the service is known again after a restart.
void Queue::note_renderer(Work& work, pid_t pid) {
  const auto identity = identity_of(pid);
  if (!identity) return;
  const std::lock_guard lock(mutex_);
  JobControl control = work.control;
  control.renderer_pid = identity->pid;
  control.renderer_start = static_cast<std::int64_t>(identity->start_ticks);
  try {
    write_control(work, control);
  } catch (const std::exception& error) {
    log::warn("{}: {}", work.id, error.what());
  }
}

void Queue::settle(Work& work, Attempt attempt) {
  const auto progress = table_.folder(work.id).read_progress();
  if (progress) attempt.iteration_after = progress->iteration;
  const std::lock_guard lock(mutex_);
  attempt.cancel = work.control.cancel;
  attempt.hold = work.control.held;
  attempt.stopped = stopping_ || work.stopped_for_disk;
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
    work.not_before = Clock::now() + back_off(control.crashes);
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
