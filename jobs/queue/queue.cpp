#include "jobs/queue/queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/log/log.h"
#include "base/storage/atomic_file.h"
#include "base/storage/passing_error.h"
#include "jobs/queue/child_process.h"
#include "jobs/spec/budget_extension.h"
#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/store/new_folder.h"

namespace lacuna {
namespace {

/// Checks that the job has the client's `revision`.
JobEntry checked(std::optional<JobEntry> entry, const std::string& revision) {
  if (!entry) throw Conflict("The job no longer exists.");
  const std::string now = std::to_string(entry->revision);
  if (!revision.empty() && revision != "*" && revision != now) {
    throw Changed(fmt::format("The job has changed: its revision is now {}.", now));
  }
  return std::move(*entry);
}

}  // namespace

Queue::Queue(Executor& executor, Store& store, std::filesystem::path jobs, DiskWatch& disk,
             QueueSettings settings)
    : executor_(executor),
      store_(store),
      jobs_(std::move(jobs)),
      disk_(disk),
      settings_(settings) {}

std::size_t Queue::room() const {
  return settings_.max_waiting - std::min(settings_.max_waiting, unfinished_of(store_.counts()));
}

void Queue::check_room() const {
  if (room() == 0) {
    throw Full(fmt::format("{} jobs wait or run, which is the maximum.", settings_.max_waiting));
  }
}

void Queue::take_up(const std::vector<JobEntry>& added) {
  for (const JobEntry& entry : added) {
    try {
      make_folder(entry);
    } catch (const std::exception& error) {  // its runner retries
      log::warn("{}: {}", entry.id, error.what());
    }
  }
  const std::lock_guard lock(mutex_);
  changed_.notify_all();
}

/// Writes the end of a job into its folder if no renderer has.
void Queue::note_end(const JobEntry& entry) const {
  const JobFolder job = folder(entry.id);
  try {
    if (job.read_state().state != entry.state.state) job.write_state(entry.state, false);
  } catch (const std::exception& error) {  // the store has it
    log::warn("{}: {}", entry.id, error.what());
  }
  on_over_();
}

/// Creates the folder from the store. Not synced: it is created again if it is missing.
void Queue::make_folder(const JobEntry& entry) const {
  const JobFolder job = folder(entry.id);
  std::filesystem::create_directories(job.dir());
  const auto said = [&] {
    try {
      return job.read_job_text();
    } catch (const std::exception& error) {
      if (may_pass(error)) throw;
      return std::string();
    }
  };
  if (!is_job(job) || said() != entry.spec) {
    write_file_atomically(job.file("job.json"), entry.spec, false);
  }
  if (settings_.lasting && !std::filesystem::exists(job.file("accepted.json"))) {
    job.write_acceptance({entry.number, entry.state.created, entry.sweep, entry.shards,
                          entry.key.value_or(""), entry.body_hash});
  }
}

void Queue::change(const std::string& id, std::optional<int> priority, std::optional<bool> held,
                   const std::string& revision) {
  const std::lock_guard lock(mutex_);
  const auto taken = work_.find(id);
  store_.change([&](StoreChange& c) {
    JobEntry entry = checked(c.find_job(id), revision);
    if (entry.over()) {
      throw Conflict(
          fmt::format("The job is {}: it is not waiting.", enum_name(entry.state.state)));
    }
    const bool same = priority.value_or(entry.priority) == entry.priority &&
                      held.value_or(entry.held) == entry.held;
    if (same) return;
    if (entry.cancel) throw Conflict("The job is being cancelled.");
    entry.priority = priority.value_or(entry.priority);
    entry.held = held.value_or(entry.held);
    // A job with a runner is held when its renderer has ended.
    if (taken == work_.end() && !entry.begun) {
      entry.state.state = entry.held ? State::held : State::queued;
    }
    c.put(std::move(entry));
  });
  changed_.notify_all();
  if (taken == work_.end()) return;
  if (priority) executor_.set_priority(folder(id), *priority);
  if (held.value_or(false)) taken->second->stop.request();
}

void Queue::cancel(const std::string& id, const std::string& revision) {
  const std::lock_guard lock(mutex_);
  const auto taken = work_.find(id);
  std::optional<JobEntry> over;
  store_.change([&](StoreChange& c) {
    JobEntry entry = checked(c.find_job(id), revision);
    if (entry.state.state == State::cancelled) return;
    if (entry.over()) throw Conflict(fmt::format("The job is {}.", enum_name(entry.state.state)));
    entry.cancel = true;
    if (taken == work_.end() && !entry.begun) {
      entry.state = ended(entry.state, State::cancelled, utc_now());
      entry.obstacle.clear();
      over = entry;
    } else {
      entry.state.state = State::cancelling;
    }
    c.put(std::move(entry));
  });
  changed_.notify_all();
  if (over) note_end(*over);
  if (taken != work_.end()) taken->second->stop.request();
}

/// Reopens a job that was over. Throws Conflict, std::system_error.
JobEntry Queue::reopened(JobEntry entry) const {
  const JobFolder job = folder(entry.id);
  if (std::filesystem::exists(job.dir())) {
    const std::lock_guard no_forks(fork_mutex());
    const auto free = job.try_lock();
    if (!free) throw Conflict("A renderer is still running in the job's folder.");
    executor_.forget(job);
  }
  entry.cancel = entry.held = false;
  entry.reopened = true;
  entry.crashes = 0;
  entry.state = queued(entry.state);
  return entry;
}

void Queue::retry(const std::string& id, const std::string& revision) {
  const std::lock_guard lock(mutex_);
  store_.change([&](StoreChange& c) {
    JobEntry entry = checked(c.find_job(id), revision);
    if (!allows(entry.state.state, JobAction::retry)) {
      throw Conflict(fmt::format("The job is {}: only failed and cancelled jobs can be retried.",
                                 enum_name(entry.state.state)));
    }
    c.put(reopened(std::move(entry)));
  });
  pauses_.erase(id);
  changed_.notify_all();
}

void Queue::extend(const std::string& id, const Budget& budget, const std::string& revision) {
  const std::lock_guard lock(mutex_);
  store_.change([&](StoreChange& c) {
    JobEntry entry = checked(c.find_job(id), revision);
    if (!allows(entry.state.state, JobAction::extend)) {
      throw Conflict(fmt::format("The job is {}: only a job that is over can be extended.",
                                 enum_name(entry.state.state)));
    }
    JobSpec spec = parse_job(entry.spec);
    throw_if_any(extension_problems(spec.budget, budget));
    spec.budget = budget;
    take_spec(entry, spec);
    c.put(reopened(std::move(entry)));
  });
  pauses_.erase(id);
  changed_.notify_all();
}

/// Only under the lock.
void Queue::check_all_removable(const std::vector<std::string>& ids) const {
  for (const std::string& id : ids) {
    const JobEntry entry = checked(store_.find(id), {});
    if (!allows(entry.state.state, JobAction::remove)) {
      throw Conflict(fmt::format("Job {} is {}: only a job that is over can be removed.", id,
                                 enum_name(entry.state.state)));
    }
    const auto sweep = store_.find_sweep(entry.sweep);
    if (sweep && !is_over(sweep->state)) {
      throw Conflict(fmt::format("It is a run of sweep {}, which is not over.", entry.sweep));
    }
    if (const auto user = store_.merged_from(entry.sweep); user && !user->over()) {
      throw Conflict(fmt::format("Job {} will be merged from {}.", user->id, id));
    }
    if (const auto user = store_.measured_against(id)) {
      throw Conflict(fmt::format("Job {} measures its error against {}.", *user, id));
    }
  }
}

void Queue::check_removable(const std::vector<std::string>& ids) const {
  const std::lock_guard lock(mutex_);
  check_all_removable(ids);
}

void Queue::remove(const std::string& id, const std::string& revision) {
  const std::lock_guard lock(mutex_);
  checked(store_.find(id), revision);
  take_away({id});
}

void Queue::remove_all(const std::vector<std::string>& ids) {
  const std::lock_guard lock(mutex_);
  take_away(ids);
}

/// Only under the lock. Renames the folders to hidden names first: after a crash in between, jobs
/// without results remain, which can be removed again.
void Queue::take_away(const std::vector<std::string>& ids) {
  check_all_removable(ids);
  const std::lock_guard no_forks(fork_mutex());
  std::vector<JobFolder::Lock> taken;
  std::vector<std::filesystem::path> folders;
  for (const std::string& id : ids) {
    const JobFolder job = folder(id);
    if (is_gone(job.dir())) continue;
    auto lock = job.try_lock();
    if (!lock) throw Conflict(fmt::format("A renderer is still running in the folder of {}.", id));
    taken.push_back(std::move(*lock));
    folders.push_back(job.dir());
  }
  std::vector<std::filesystem::path> hidden = take_folders_away(folders);
  try {
    store_.change([&](StoreChange& c) {
      for (const std::string& id : ids) c.remove_job(id);
    });
  } catch (...) {
    for (std::size_t i = 0; i < hidden.size(); ++i) {
      std::error_code lost;  // the results are lost, the job remains
      std::filesystem::rename(hidden[i], folders[i], lost);
    }
    throw;
  }
  trash_.take(std::move(hidden));
}

}  // namespace lacuna
