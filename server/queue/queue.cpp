#include "server/queue/queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "analysis/storage/passing_error.h"
#include "jobs/spec/budget_extension.h"
#include "jobs/spec/described_json.h"
#include "jobs/store/new_folder.h"
#include "server/queue/child_process.h"
#include "server/telemetry/log.h"

namespace lacuna {

Queue::Queue(Executor& executor, JobTable& table, DiskWatch& disk, QueueSettings settings)
    : executor_(executor), table_(table), disk_(disk), settings_(settings) {}

void Queue::start() {
  for (const EntryPtr& entry : table_.all()) {
    if (entry->damaged) log::error("{} is left alone: {}", entry->id, entry->state.error);
    enter(entry->id);
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
      if (!work->stop) continue;
      if (executor_.is_remote()) {
        work->stop->leave();
      } else {
        work->stop->request();
      }
    }
  }
  changed_.notify_all();
  runners_.clear();
}

std::size_t Queue::room() const {
  const std::lock_guard lock(mutex_);
  return settings_.max_waiting - std::min(settings_.max_waiting, work_.size());
}

void Queue::check_room() const {
  if (room() == 0) {
    throw Full(
        fmt::format("{} jobs wait or run, and there may be no more.", settings_.max_waiting));
  }
}

EntryPtr Queue::add(const std::string& id) {
  EntryPtr entry = table_.add(id);
  enter(id);
  return entry;
}

void Queue::adopt() {
  for (const EntryPtr& entry : table_.all()) {
    if (!entry->over) enter(entry->id);
  }
}

/// A job that is not over comes in: new, or left by an earlier run of the service.
void Queue::enter(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const EntryPtr entry = table_.find(id);
  if (!entry || entry->over || work_.contains(id)) return;
  const WorkPtr work = open(*entry, entry->control);
  try {
    place(*entry, *work);
  } catch (const std::exception& error) {
    if (!may_pass(error)) return give_up(id, error.what());
    postpone(*work, error);
    line_up(*work);
  }
}

/// Where it belongs by its state. Throws before anything has changed.
void Queue::place(const JobEntry& entry, Work& work) {
  if (entry.unread) return line_up(work);
  const State state = entry.state.state;
  if (state == State::cancelling) work.control.cancel = true;
  if (work.control.cancel && withdraw(work, State::cancelled)) return;
  if (work.control.held && withdraw(work, State::held)) return;
  // Where a renderer of an earlier service still ends, its state.json is not ours yet.
  if (state != State::queued) withdraw(work, State::queued);
  // Unless that renderer has come to the end just now, and the job is over.
  if (work_.contains(entry.id)) line_up(work);
}

Queue::WorkPtr Queue::open(const JobEntry& entry, const JobControl& control) {
  auto work = std::make_shared<Work>();
  work->id = entry.id;
  work->created = entry.state.created;
  work->exclusive = entry.exclusive && !executor_.is_remote();
  work->control = control;
  work_[work->id] = work;
  return work;
}

void Queue::line_up(Work& work) {
  const bool to_submit = !executor_.holds(table_.folder(work.id));
  work.queue_key = QueueKey{to_submit, -work.control.priority, work.created, work.id};
  line_.insert(*work.queue_key);
  if (waits_for_shards(work)) {
    table_.set_place(work.id, fmt::format("nowhere yet: it waits for its shards, the runs of {}",
                                          work.control.shards));
  }
  changed_.notify_all();
}

void Queue::leave_line(Work& work) {
  if (work.queue_key) line_.erase(*work.queue_key);
  work.queue_key.reset();
}

/// Takes a job that no runner has, so that its state can be written. Nothing: a renderer of
/// somebody else still holds its folder, and a runner has to wait for that. Throws Conflict if the
/// folder is damaged, and std::system_error. Only under the fork mutex, which has to be held as
/// long as the claim.
std::optional<Queue::Claim> Queue::claim(const Work& work) const {
  auto lock = try_folder(work);
  if (!lock) return std::nullopt;
  try {
    return Claim{std::move(*lock), stored_state(work.id)};
  } catch (const std::exception& error) {
    if (may_pass(error)) throw;
    throw Conflict(error.what());
  }
}

/// Writes the new state of a job that is claimed.
void Queue::commit(Work& work, const JobState& before, State how) {
  if (is_terminal(before.state)) {
    table_.set_state(work.id, before, true);
    forget(work.id);
  } else if (how == State::queued) {
    write_state(work.id, queued(before), false);
  } else if (how == State::held) {
    write_state(work.id, held(before), false);
  } else {
    write_state(work.id, ended(before, how, utc_now()), true);
    forget(work.id);
  }
}

/// Both in one. False: there is no claim to be had, and nothing has changed.
bool Queue::withdraw(Work& work, State how) {
  const std::lock_guard no_forks(fork_mutex());
  const auto claimed = claim(work);
  if (claimed) commit(work, claimed->state, how);
  return claimed.has_value();
}

void Queue::forget(const std::string& id) {
  const auto found = work_.find(id);
  if (found == work_.end()) return;
  leave_line(*found->second);
  work_.erase(found);
  on_over_();
}

EntryPtr Queue::checked(const std::string& id, const std::string& revision) const {
  EntryPtr entry = table_.find(id);
  if (!entry) throw Conflict("The job no longer exists.");
  if (!revision.empty() && revision != "*" && revision != entry->revision()) {
    throw Changed(fmt::format("The job has changed: its revision is now {}.", entry->revision()));
  }
  if (entry->unread) throw Unavailable(entry->obstacle);
  return entry;
}

void Queue::write_control(Work& work, const JobControl& control) {
  table_.folder(work.id).write_control(control);
  work.control = control;
  table_.set_control(work.id, control);
}

void Queue::change(const std::string& id, std::optional<int> priority, std::optional<bool> held,
                   const std::string& revision) {
  const std::lock_guard lock(mutex_);
  const EntryPtr entry = checked(id, revision);
  const auto found = work_.find(id);
  if (found == work_.end()) {
    throw Conflict(fmt::format("The job is {}: it is not waiting.", enum_name(entry->state.state)));
  }
  Work& work = *found->second;
  JobControl control = work.control;
  control.priority = priority.value_or(control.priority);
  control.held = held.value_or(control.held);
  if (control == work.control) return;
  if (work.control.cancel) throw Conflict("The job is being cancelled.");
  if (work.stop) {  // a runner has it and looks at what was asked when its renderer has ended
    write_control(work, control);
    executor_.set_priority(table_.folder(id), control.priority);
    if (control.held) work.stop->request();
    return;
  }
  // What may fail comes first: the change is made as a whole or not at all.
  const std::lock_guard no_forks(fork_mutex());
  const bool moves = control.held || entry->state.state == State::held;
  const auto claimed = moves ? claim(work) : std::nullopt;
  write_control(work, control);
  leave_line(work);
  if (claimed) {
    const bool waits = !control.held && !is_terminal(claimed->state.state);
    commit(work, claimed->state, control.held ? State::held : State::queued);
    if (!waits) return;
  }
  line_up(work);
}

void Queue::cancel(const std::string& id, const std::string& revision) {
  const std::lock_guard lock(mutex_);
  const EntryPtr entry = checked(id, revision);
  const auto found = work_.find(id);
  if (found == work_.end()) {
    if (entry->state.state == State::cancelled) return;
    throw Conflict(fmt::format("The job is {}.", enum_name(entry->state.state)));
  }
  Work& work = *found->second;
  JobControl control = work.control;
  control.cancel = true;
  const std::lock_guard no_forks(fork_mutex());
  // What may fail comes first, as in change().
  const auto claimed = work.stop ? std::nullopt : claim(work);
  if (control != work.control) write_control(work, control);
  if (claimed) return commit(work, claimed->state, State::cancelled);
  if (work.stop) {
    work.stop->request();
  } else if (!work.queue_key) {
    line_up(work);
  }
  JobState state = entry->state;
  if (is_terminal(state.state)) return;
  state.state = State::cancelling;
  table_.set_state(id, state, false);
}

void Queue::retry(const std::string& id, const std::string& revision) {
  const std::lock_guard lock(mutex_);
  const EntryPtr entry = checked(id, revision);
  const State state = entry->state.state;
  if (!entry->over || entry->damaged || state == State::done) {
    throw Conflict(fmt::format("The job is {}: only failed and cancelled jobs can be retried.",
                               entry->damaged ? "damaged" : enum_name(state)));
  }
  line_up(reopen(entry));
}

void Queue::extend(const std::string& id, const Budget& budget, const std::string& revision) {
  const std::lock_guard lock(mutex_);
  const EntryPtr entry = checked(id, revision);
  if (!entry->over || entry->damaged) {
    throw Conflict(fmt::format("The job is {}: only a job that is over can be extended.",
                               entry->damaged ? "damaged" : enum_name(entry->state.state)));
  }
  JobSpec spec = table_.folder(id).read_job();
  throw_if_any(extension_problems(spec.budget, budget));
  spec.budget = budget;
  // First the state: a crash in between leaves a job that ends at once with its old budget, and not
  // one that says it is done and is not.
  Work& work = reopen(entry);
  try {
    table_.folder(id).write_job(spec);
  } catch (...) {
    write_state(id, entry->state, true);
    forget(id);
    throw;
  }
  table_.set_job(id, spec);
  line_up(work);
}

/// A job that was over is open again, but not in the line yet.
Queue::Work& Queue::reopen(const EntryPtr& entry) {
  const JobFolder folder = table_.folder(entry->id);
  const std::lock_guard no_forks(fork_mutex());
  const auto free = folder.try_lock();
  if (!free) throw Conflict("A renderer is still running in the job's folder.");
  executor_.forget(folder);
  JobControl control = entry->control;
  control.cancel = control.held = false;
  control.crashes = 0;
  const JobState state = queued(folder.read_state());
  folder.write_control(control);  // which changes nothing while the state says that it is over
  folder.write_state(state);
  unsaved_.erase(entry->id);
  table_.set_control(entry->id, control);
  table_.set_state(entry->id, state, false);
  return *open(*entry, control);
}

/// Only under the lock.
void Queue::check_all_removable(const std::vector<std::string>& ids) const {
  // What cannot be read now may need any of them.
  if (const EntryPtr unread = table_.unread()) {
    throw Unavailable(fmt::format("Job {} may need it: {}", unread->id, unread->obstacle));
  }
  for (const std::string& id : ids) {
    const EntryPtr entry = checked(id, {});
    if (!entry->over) {
      throw Conflict(fmt::format("Job {} is {}: only a job that is over can be removed.", id,
                                 enum_name(entry->state.state)));
    }
    const SweepEntryPtr sweep = table_.sweeps().find(entry->sweep);
    if (sweep && sweep->unread) throw Unavailable(sweep->error);
    if (sweep && !is_over(sweep->state.state)) {
      throw Conflict(fmt::format("Sweep {}, which it is a run of, is not over.", entry->sweep));
    }
    if (const EntryPtr user = table_.merged_from(entry->sweep); user && !user->over) {
      throw Conflict(fmt::format("Job {} is to be merged from {}.", user->id, id));
    }
    if (const auto user = table_.measured_against(id)) {
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
  checked(id, revision);
  take_away({id});
}

/// Its folder says so itself: what is known here only is not what a restart would find.
bool Queue::is_over_on_disk(const std::string& id) const {
  return !unsaved_.contains(id) && is_terminal(table_.folder(id).read_state().state);
}

void Queue::remove_outdated(const std::string& id) {
  const std::lock_guard lock(mutex_);
  if (!is_over_on_disk(id)) throw Conflict("Its folder does not say that it is over.");
  take_away({id});
}

void Queue::remove_all(const std::vector<std::string>& ids) {
  const std::lock_guard lock(mutex_);
  take_away(ids);
}

/// Only under the lock.
void Queue::take_away(const std::vector<std::string>& ids) {
  check_all_removable(ids);
  const std::lock_guard no_forks(fork_mutex());
  std::vector<JobFolder::Lock> taken;
  std::vector<std::filesystem::path> folders;
  for (const std::string& id : ids) {
    const JobFolder folder = table_.folder(id);
    auto lock = folder.try_lock();
    if (!lock) throw Conflict(fmt::format("A renderer is still running in the folder of {}.", id));
    taken.push_back(std::move(*lock));
    folders.push_back(folder.dir());
  }
  trash_.take(take_folders_away(folders));
  for (const std::string& id : ids) table_.remove(id);
}

void Queue::look_at_disk() {
  const bool low = disk_.is_low();
  const std::lock_guard lock(mutex_);
  for (const auto& [id, work] : work_) {
    if (!low || !work->stop) continue;
    work->stopped_for_disk = true;
    work->stop->request();
  }
  changed_.notify_all();
}

void Queue::look_at_running() {
  const std::lock_guard lock(mutex_);  // or an old state could be told after a new one
  for (const auto& [id, work] : work_) {
    if (!work->stop) continue;
    const JobFolder folder = table_.folder(id);
    try {
      if (const auto progress = folder.read_progress()) table_.set_progress(id, *progress);
      JobState state = stored_state(id);
      // An end counts once its runner has seen it: only then can the job be removed or extended.
      if (is_terminal(state.state)) continue;
      if (work->control.cancel) state.state = State::cancelling;
      table_.set_state(id, state, false);
    } catch (const std::exception& error) {  // its runner will find out, too
      log::debug("{}: {}", id, error.what());
    }
  }
}

/// Throws std::runtime_error if the job's folder does not say.
JobState Queue::stored_state(const std::string& id) const {
  const auto unsaved = unsaved_.find(id);
  return unsaved != unsaved_.end() ? unsaved->second : table_.folder(id).read_state();
}

void Queue::write_state(const std::string& id, const JobState& state, bool over) {
  try {
    const State before = stored_state(id).state;
    if (before != state.state && !may_follow(before, state.state)) {
      log::error("{}: {} may not follow {}", id, enum_name(state.state), enum_name(before));
    }
    table_.folder(id).write_state(state);
    unsaved_.erase(id);
  } catch (const std::exception& error) {
    log::error("{}: its state could not be saved: {}", id, error.what());
    unsaved_[id] = state;
  }
  table_.set_state(id, state, over);
}

void Queue::save_pending() {
  const std::lock_guard lock(mutex_);
  std::erase_if(unsaved_, [&](const auto& pending) {
    const auto& [id, state] = pending;
    try {
      table_.folder(id).write_state(state);
      return true;
    } catch (const std::exception&) {
      return is_gone(table_.folder(id).dir());
    }
  });
}

}  // namespace lacuna
