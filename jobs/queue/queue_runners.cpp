// The runners of a queue: each takes the first job that may start, renders it with the executor,
// and classifies the end.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <utility>

#include "base/log/log.h"
#include "base/storage/passing_error.h"
#include "jobs/queue/child_process.h"
#include "jobs/queue/process_identity.h"
#include "jobs/queue/queue.h"

namespace lacuna {
namespace {

// Polling interval for a lock held by another renderer, and for a job's shards.
constexpr std::chrono::milliseconds look_again_at_lock{100};
constexpr std::chrono::seconds look_again_at_shards{1};
// Longest pauses. After a crash, which the job itself may cause; and after transient errors, for
// which the queue should not wait much longer than they last.
constexpr std::chrono::minutes longest_after_crash{1};
constexpr std::chrono::seconds longest_after_fault{30}, longest_pause{5};

/// The public part of an error, without file names.
std::string general_reason(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);
  return system != nullptr ? system->code().message() : error.what();
}

ProcessIdentity renderer_of(const JobEntry& entry) {
  return {static_cast<pid_t>(entry.renderer_pid), static_cast<std::uint64_t>(entry.renderer_start),
          entry.renderer_boot};
}

}  // namespace

void Queue::start() {
  // Local renderers have ended with the previous service, or are about to.
  if (!executor_.is_remote()) {
    store_.change([&](StoreChange& c) {
      for (const JobEntry& known : c.begun_jobs()) {
        JobEntry entry = known;
        if (!entry.cancel) entry.state = queued(entry.state);
        c.put(std::move(entry));
      }
    });
  }
  for (int i = 0; i < settings_.children; ++i) {
    runners_.emplace_back([this](const std::stop_token& ends) { run(ends); });
  }
}

void Queue::stop() {
  {
    const std::lock_guard lock(mutex_);
    for (std::jthread& runner : runners_) runner.request_stop();
    for (const auto& [id, work] : work_) {
      if (executor_.is_remote()) {
        work->stop.leave();
      } else {
        work->stop.request();
      }
    }
  }
  changed_.notify_all();
  runners_.clear();
}

void Queue::run(const std::stop_token& ends) {
  while (const WorkPtr work = take(ends)) {
    try {
      attend(*work, ends);
    } catch (const std::exception& error) {
      if (may_pass(error)) {
        postpone(work->id, error);
      } else {
        give_up(work->id, error.what());
      }
    }
    const std::lock_guard lock(mutex_);
    work_.erase(work->id);
    exclusive_runs_ = false;
    changed_.notify_all();
  }
}

Queue::WorkPtr Queue::take(const std::stop_token& ends) {
  std::unique_lock lock(mutex_);
  for (;;) {
    if (ends.stop_requested()) return nullptr;
    auto look_again = Clock::now() + std::chrono::hours(1);
    std::string id;
    try {
      if (const auto entry = first_ready(look_again)) {
        id = entry->id;
        auto work = std::make_shared<Work>();
        work->id = id;
        work->exclusive = entry->exclusive && !executor_.is_remote();
        exclusive_runs_ = work->exclusive;
        work_[id] = work;
        return work;
      }
    } catch (const std::exception& error) {  // the database failed, or no descriptor is left
      log::warn("no job can be started: {}", error.what());
      look_again = Clock::now() + longest_pause;
    }
    changed_.wait_until(lock, look_again);
  }
}

/// The first queued job that may start now; sets `look_again` to the time when a pause ends. Only
/// under the lock.
std::optional<JobEntry> Queue::first_ready(Clock::time_point& look_again) const {
  if (exclusive_runs_ || disk_.is_low()) return std::nullopt;
  const auto now = Clock::now();
  {
    const std::lock_guard lock(faults_mutex_);
    if (paused_until_ > now) {
      look_again = paused_until_;
      return std::nullopt;
    }
  }
  constexpr std::size_t at_once = 64;
  for (std::size_t begin = 0;; begin += at_once) {
    const std::vector<JobEntry> line = store_.unfinished(begin, at_once);
    for (const JobEntry& entry : line) {
      if (work_.contains(entry.id)) continue;
      const auto pause = pauses_.find(entry.id);
      if (pause != pauses_.end() && pause->second.until > now) {
        look_again = std::min(look_again, pause->second.until);
      } else if (waits_for_shards(entry)) {
        look_again = std::min(look_again, now + look_again_at_shards);
      } else {
        const bool alone = entry.exclusive && !executor_.is_remote();
        if (alone && !work_.empty()) return std::nullopt;
        return entry;
      }
    }
    if (line.size() < at_once) return std::nullopt;
  }
}

/// A job is merged once its shards are rendered; one with a checkpoint is merged already.
bool Queue::waits_for_shards(const JobEntry& entry) const {
  if (entry.shards.empty() || entry.cancel) return false;
  const auto sweep = store_.find_sweep(entry.shards);
  if (!sweep) return false;
  if (is_over(sweep->state) && unfinished_of(store_.run_counts(entry.shards)) == 0) return false;
  std::error_code unknown;  // it waits until this can be determined
  return !std::filesystem::exists(folder(entry.id).file("checkpoint.bin"), unknown);
}

/// Locks the job's folder; none while a renderer holds it or may be about to lock it. Only under
/// the fork mutex.
std::optional<JobFolder::Lock> Queue::try_folder(const JobEntry& entry) const {
  const ProcessIdentity renderer = renderer_of(entry);
  if (renderer.pid > 0 && is_alive(renderer)) return std::nullopt;
  return folder(entry.id).try_lock();
}

/// Waits while another renderer holds the folder; one that an earlier run of this service started
/// received a stop request and is killed after the grace period. False if a stop was requested.
bool Queue::wait_until_free(const JobEntry& entry, const std::stop_token& ends) {
  const auto is_free = [&] {
    const std::lock_guard no_forks(fork_mutex());
    return try_folder(entry).has_value();
  };
  const auto patience = Clock::now() + settings_.grace;
  bool killed = false;
  while (!is_free()) {
    if (!killed && Clock::now() >= patience) {
      killed = kill_group(renderer_of(entry), SIGKILL);
      if (killed) log::warn("{}: an earlier renderer did not stop and is killed", entry.id);
    }
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, look_again_at_lock, [&] { return ends.stop_requested(); })) {
      return false;
    }
  }
  return true;
}

void Queue::attend(Work& work, const std::stop_token& ends) {
  const auto entry = store_.find(work.id);
  if (!entry || entry->over()) return;
  std::optional<Attempt> attempt;
  {
    const std::lock_guard lock(mutex_);
    if (const auto pause = pauses_.find(work.id); pause != pauses_.end()) {
      attempt = std::exchange(pause->second.ended, std::nullopt);
    }
  }
  if (!attempt) {
    make_folder(*entry);
    if (!executor_.holds(folder(work.id)) && !wait_until_free(*entry, ends)) return;
    attempt = render(work, *entry);
  }
  if (attempt) judge(work, std::move(*attempt), ends);
}

/// Renders the job. None if it shall not be rendered, or if its renderer continues without this
/// service.
std::optional<Attempt> Queue::render(Work& work, const JobEntry& entry) {
  const JobFolder job = folder(work.id);
  Attempt attempt;
  attempt.found = executor_.holds(job);
  if (entry.reopened && !attempt.found) job.reopen();
  attempt.before = job.read_state();
  if (const auto progress = job.read_progress()) attempt.iteration_before = progress->iteration;
  // A renderer of an earlier service has finished.
  if (!attempt.found && is_terminal(attempt.before.state)) {
    attempt.found = true;
    attempt.ending.reason = "an earlier renderer had ended";
    return attempt;
  }
  if (!may_render(work, attempt)) return std::nullopt;
  log::info("{}: {}", work.id,
            attempt.found ? "continuing with its running renderer" : "starting a renderer");
  attempt.ending =
      executor_.run({job, entry.priority, entry.crashes}, work.stop,
                    {.started = [&](pid_t pid) { note_start(work, pid); },
                     .place =
                         [&](const std::string& place) {
                           update_live(work, [&](LiveState& live) { live.place = place; });
                         }});
  log::info("{}: {}", work.id, attempt.ending.reason);
  if (attempt.ending.kind == Ending::Kind::left) return std::nullopt;
  return attempt;
}

/// Records the state before the renderer starts. False if a request prevents the start.
bool Queue::may_render(Work& work, Attempt& attempt) {
  bool may = false;
  std::optional<JobEntry> over;
  store_.change([&](StoreChange& c) {
    auto entry = c.find_job(work.id);
    if (!entry) return;
    attempt.before.attempts = std::max(attempt.before.attempts, entry->state.attempts);
    attempt.crashes = entry->crashes;
    entry->reopened = false;
    if (attempt.found) {
      if (entry->cancel || entry->held) work.stop.request();
      may = true;
    } else if (entry->cancel || entry->held) {
      entry->begun = false;
      entry->state =
          entry->cancel ? ended(entry->state, State::cancelled, utc_now()) : held(entry->state);
      if (entry->cancel) over = entry;
    } else {
      may = true;
    }
    c.put(std::move(*entry));
  });
  if (over) note_end(*over);
  return may;
}

/// Called when a renderer has begun: ends the queue's pauses, and stores the process so that it is
/// found after a restart if it outlives the service.
void Queue::note_start(Work& work, pid_t pid) {
  {
    const std::lock_guard lock(mutex_);
    const std::lock_guard faults(faults_mutex_);
    work.faults_of_all = std::exchange(faults_, 0);
    if (work.faults_of_all > 1) {  // errors of more than one folder
      for (auto& [id, pause] : pauses_) {
        if (pause.faults > 0) pause.until = {};
      }
    }
  }
  const auto identity = identity_of(pid);
  try {
    store_.change([&](StoreChange& c) {
      auto entry = c.find_job(work.id);
      if (!entry) return;
      entry->begun = true;
      entry->obstacle.clear();
      if (identity) {
        entry->renderer_pid = identity->pid;
        entry->renderer_start = static_cast<std::int64_t>(identity->start_ticks);
        entry->renderer_boot = identity->boot;
        if (entry->state.state == State::queued) entry->state.state = State::running;
        entry->state.attempts += 1;
        entry->state.started = utc_now();
      }
      c.put(std::move(*entry));
    });
  } catch (const std::exception& error) {
    log::warn("{}: {}", work.id, error.what());
  }
}

/// Classifies how a renderer ended, retrying until this can be read and stored: as long as that
/// fails, nothing else can start either.
void Queue::judge(Work& work, Attempt attempt, const std::stop_token& ends) {
  try {
    attempt.after = folder(work.id).read_state();
  } catch (const std::exception& error) {
    if (may_pass(error)) {  // classified when it can be read
      const std::lock_guard lock(mutex_);
      pauses_[work.id].ended = std::move(attempt);
      throw;
    }
    log::error("{}: {}", work.id, error.what());
    attempt.after = attempt.before;
  }
  attempt.stopped = ends.stop_requested() || work.stop.is_requested();
  attempt.disk_low = disk_.is_low();
  for (int faults = 1;; ++faults) {
    try {
      return settle(work, attempt);
    } catch (const std::exception& error) {
      if (!may_pass(error)) throw;
      log::warn("{}: its state cannot be saved: {}", work.id, error.what());
      {
        const std::lock_guard lock(faults_mutex_);
        faults_ = std::max(faults_, faults);
        obstacle_ = "states of jobs that have ended cannot be saved";
      }
      std::unique_lock lock(mutex_);
      const auto pause = pause_after_fault(faults, longest_pause);
      // The next service reads the end from outcome.json.
      if (changed_.wait_for(lock, pause, [&] { return ends.stop_requested(); })) return;
    }
  }
}

void Queue::settle(Work& work, Attempt& attempt) {
  const JobFolder job = folder(work.id);
  const auto progress = job.read_progress();
  if (progress) attempt.iteration_after = progress->iteration;
  const bool pictured = has_picture(job);
  ExitClassification exit;
  std::optional<JobEntry> settled;
  store_.change([&](StoreChange& c) {
    settled = c.find_job(work.id);
    if (!settled) return;
    attempt.cancel = settled->cancel;
    attempt.hold = settled->held;
    exit = classify_exit(attempt, settings_.max_attempts, utc_now());
    const std::string created = settled->state.created;
    settled->state = exit.state;
    settled->state.created = created;
    settled->begun = false;
    settled->crashes += exit.crashed ? 1 : 0;
    settled->obstacle = exit.obstacle;
    if (progress) settled->progress = progress;
    settled->pictured = pictured;
    c.put(*settled);
  });
  if (!settled) return;
  {
    const std::lock_guard lock(mutex_);
    const bool came_on = attempt.iteration_after > attempt.iteration_before;
    Pause& pause = pauses_[work.id];
    if (exit.obstacle.empty() || came_on) pause.faults = 0;
    pause.until = exit.crashed
                      ? Clock::now() + pause_after_fault(settled->crashes, longest_after_crash)
                      : Clock::time_point{};
    if (exit.obstacle.empty() && !exit.crashed) pauses_.erase(work.id);
    if (!exit.obstacle.empty() && !came_on) {
      const std::lock_guard faults(faults_mutex_);
      faults_ = std::max(faults_, work.faults_of_all);  // its start was no progress
    }
  }
  if (!exit.obstacle.empty()) {
    note_obstacle(work.id, exit.obstacle, "renderers cannot be started or cannot use their files");
  }
  if (settled->over()) note_end(*settled);
}

/// Postpones a job after a transient error.
void Queue::postpone(const std::string& id, const std::exception& error) {
  note_obstacle(id, error.what(), general_reason(error));
}

/// Tries the next job after a pause, and this one later: an error of one folder may not concern
/// others. `for_all`: `what` without file names.
void Queue::note_obstacle(const std::string& id, const std::string& what,
                          const std::string& for_all) {
  {
    const std::lock_guard lock(mutex_);
    const std::lock_guard faults(faults_mutex_);
    paused_until_ = Clock::now() + pause_after_fault(++faults_, longest_pause);
    Pause& pause = pauses_[id];
    pause.until = paused_until_ + pause_after_fault(++pause.faults, longest_after_fault);
    if (obstacle_ != for_all) log::warn("jobs wait: {}", what);
    obstacle_ = for_all;
  }
  try {
    store_.change([&](StoreChange& c) {
      auto entry = c.find_job(id);
      if (!entry || entry->over()) return;
      entry->obstacle = what;
      c.put(std::move(*entry));
    });
  } catch (const std::exception& error) {
    log::warn("{}: {}", id, error.what());
  }
}

/// Fails a job whose folder is damaged.
void Queue::give_up(const std::string& id, const std::string& reason) {
  log::error("{} has failed: {}", id, reason);
  try {
    store_.change([&](StoreChange& c) {
      auto entry = c.find_job(id);
      if (!entry) return;
      entry->state = ended(entry->state, State::failed, utc_now());
      entry->state.error = reason;
      entry->begun = false;
      c.put(std::move(*entry));
    });
    on_over_();
  } catch (const std::exception& error) {
    postpone(id, error);
  }
}

}  // namespace lacuna
