#include "server/sweeps/sweep_keeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "analysis/storage/passing_error.h"
#include "jobs/plan/shard_sweep.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

// Notices bring nearly all that happens; this finds the rest, as room on the disk, or a job that
// somebody has removed by hand.
constexpr std::chrono::seconds look_again{1};

}  // namespace

SweepKeeper::SweepKeeper(SweepTable& sweeps, JobTable& jobs, Queue& queue, DiskWatch& disk,
                         std::size_t kept_free)
    : sweeps_(sweeps), jobs_(jobs), queue_(queue), disk_(disk), kept_free_(kept_free) {
  queue_.on_over([this] { notice(); });
}

void SweepKeeper::start() {
  thread_ = std::jthread([this](const std::stop_token& ends) { run(ends); });
}

void SweepKeeper::stop() { thread_ = {}; }

void SweepKeeper::notice() {
  {
    const std::lock_guard lock(signal_);
    noticed_ = true;
  }
  changed_.notify_all();
}

void SweepKeeper::run(const std::stop_token& ends) {
  for (;;) {
    {
      std::unique_lock lock(signal_);
      changed_.wait_for(lock, ends, look_again, [&] { return noticed_; });
      if (ends.stop_requested()) return;
      noticed_ = false;
    }
    try {
      look_after_all(ends);
    } catch (const std::exception& error) {
      log::error("looking after the sweeps: {}", error.what());
    }
  }
}

/// A run of each in turn, so that all sweeps come on together.
void SweepKeeper::look_after_all(const std::stop_token& ends) {
  make_missing();
  const auto unfinished = sweeps_.unfinished();
  std::erase_if(feeds_, [&](const auto& feed) { return !unfinished.contains(feed.first); });
  for (bool busy = true; busy;) {
    busy = false;
    for (const std::string& id : unfinished) {
      if (ends.stop_requested()) return;
      try {
        busy = look_after(id) || busy;
      } catch (const std::exception& error) {  // the others go on
        log::error("{}: {}", id, error.what());
      }
    }
  }
}

void SweepKeeper::make_missing() {
  for (const EntryPtr& job : jobs_.without_shards()) {
    try {
      if (std::filesystem::exists(jobs_.folder(job->id).file("checkpoint.bin"))) continue;
      const std::string& id = job->control.shards;
      const SweepSpec shards = shard_sweep(jobs_.folder(job->id).read_job());
      const SweepEntryPtr sweep = sweeps_.create_again(id, shards, expand(shards));
      for (std::size_t i = 0; i < sweep->state.runs; ++i) {
        jobs_.find_sweep(run_job_id(id, i));
      }
      log::info("{}: its shards are the runs of {}", job->id, id);
    } catch (const std::exception& error) {  // the next look may bring more
      log::warn("{}: its shards are not made: {}", job->id, error.what());
    }
  }
}

/// A sweep that could not be read, with what is known by then of its jobs. True: it can be now.
bool SweepKeeper::read_again(const std::string& id) {
  if (!sweeps_.reread(id)) return false;
  JobTable::Query runs;
  runs.sweep = id;
  runs.limit = std::numeric_limits<std::size_t>::max();
  for (const EntryPtr& job : jobs_.list(runs).jobs) jobs_.find_sweep(job->id);
  return true;
}

/// The job that is to be merged from its runs has come to another end.
bool SweepKeeper::is_in_vain(const std::string& id) const {
  const EntryPtr job = jobs_.merged_from(id);
  return job && job->over && job->state.state != State::done;
}

/// Whether it may be worth while to look again at once.
bool SweepKeeper::look_after(const std::string& id) {
  const SweepEntryPtr sweep = sweeps_.find(id);
  if (!sweep || is_over(sweep->state.state)) return false;
  if (sweep->unread) return read_again(id);
  if (sweep->state.state == SweepStage::running && is_in_vain(id)) cancel(id);
  if (sweep->state.state == SweepStage::cancelling) {
    cancel_runs(id);
    if (jobs_.run_counts(id).unfinished.empty()) sweeps_.set_stage(id, SweepStage::cancelled);
    return false;
  }
  Feed& feed = feeds_[id];
  if (!feed.folder) {
    try {
      feed.folder = sweeps_.open(id);
    } catch (const std::exception& error) {
      if (may_pass(error)) throw;  // the next look may bring more
      sweeps_.give_up(id, fmt::format("the sweep's folder cannot be read: {}", error.what()));
      return false;
    }
  }
  return make_next(id, feed);
}

/// Makes the next run, if there may be one more; or ends the sweep. False: nothing can be done now.
bool SweepKeeper::make_next(const std::string& id, Feed& feed) {
  const std::lock_guard lock(mutex_);
  const SweepEntryPtr sweep = sweeps_.find(id);
  if (!sweep || sweep->state.state != SweepStage::running) return false;
  const JobTable::RunCounts run_counts = jobs_.run_counts(id);
  const auto& runs = feed.folder->plan().runs;
  while (feed.next < runs.size() && jobs_.find(feed.folder->job_id(runs[feed.next]))) ++feed.next;
  if (feed.next == runs.size()) {
    if (!run_counts.unfinished.empty()) return false;
    if (run_counts.jobs() == runs.size()) {
      sweeps_.set_stage(id, SweepStage::done);
      log::info("{}: done, {} runs", id, runs.size());
      return false;
    }
    feed.next = 0;  // somebody has removed a run's folder: it is made anew
    return false;
  }
  if (run_counts.unfinished.size() >= most_waiting || disk_.is_low()) return false;
  if (queue_.room() <= kept_free_) return false;
  make(feed, runs[feed.next]);
  return true;
}

void SweepKeeper::make(const Feed& feed, const SweepRun& run) {
  // The queue's order is that of creation, and of ids within one millisecond: those follow another.
  while (utc_now() == last_created_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::string id = feed.folder->make_folder(run).id();
  last_created_ = queue_.add(id)->state.created;
  log::debug("{}: run {} of sweep {}", id, run.name, feed.folder->id());
}

SweepEntryPtr SweepKeeper::checked(const std::string& id) const {
  SweepEntryPtr sweep = sweeps_.find(id);
  if (!sweep) throw Conflict("The sweep no longer exists.");
  if (sweep->unread) throw Unavailable(sweep->error);
  return sweep;
}

void SweepKeeper::cancel(const std::string& id) {
  {
    const std::lock_guard lock(mutex_);
    const SweepStage stage = checked(id)->state.state;
    if (stage == SweepStage::cancelled) return;
    if (is_over(stage)) throw Conflict(fmt::format("The sweep is {}.", enum_name(stage)));
    sweeps_.set_stage(id, SweepStage::cancelling);
  }
  cancel_runs(id);
  notice();
}

/// Those that wait first: or they would begin as those that run end.
void SweepKeeper::cancel_runs(const std::string& id) {
  const auto unfinished = jobs_.run_counts(id).unfinished;
  for (const bool runs : {false, true}) {
    for (const std::string& job : unfinished) {
      const EntryPtr entry = jobs_.find(job);
      if (!entry || entry->over || entry->control.cancel) continue;
      if ((entry->state.state == State::running) != runs) continue;
      try {
        queue_.cancel(job);
      } catch (const std::exception& error) {  // it is over just now; or tried again later
        log::debug("{}: {}", job, error.what());
      }
    }
  }
}

void SweepKeeper::remove(const std::string& id) {
  const SweepEntryPtr sweep = checked(id);
  const SweepStage stage = sweep->state.state;
  if (!is_over(stage)) {
    throw Conflict(fmt::format("The sweep is {}: only a sweep that is over can be removed.",
                               enum_name(stage)));
  }
  std::vector<std::string> jobs;
  for (std::size_t i = sweep->state.runs; i-- > 0;) {
    const EntryPtr run = jobs_.find(run_job_id(id, i));
    if (run && run->sweep == id) jobs.push_back(run->id);
  }
  queue_.check_removable(jobs);
  // The sweep last: a crash before leaves one that can be removed once more.
  constexpr std::size_t at_once = 100;  // the queue stands still meanwhile
  for (std::size_t i = 0; i < jobs.size(); i += at_once) {
    const auto begin = jobs.begin() + static_cast<std::ptrdiff_t>(i);
    const auto n = std::min(at_once, jobs.size() - i);
    queue_.remove_all({begin, begin + static_cast<std::ptrdiff_t>(n)});
  }
  sweeps_.remove(id);
  log::info("{}: removed, with {} jobs", id, jobs.size());
}

}  // namespace lacuna
