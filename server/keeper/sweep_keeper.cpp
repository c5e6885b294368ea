#include "server/keeper/sweep_keeper.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/log/log.h"
#include "base/storage/passing_error.h"
#include "jobs/spec/problems.h"

namespace lacuna {
namespace {

// Notices report nearly all changes; polling finds the rest, such as free disk space.
constexpr std::chrono::seconds look_again{1};

SweepEntry checked(std::optional<SweepEntry> sweep) {
  if (!sweep) throw Conflict("The sweep no longer exists.");
  return std::move(*sweep);
}

}  // namespace

SweepKeeper::SweepKeeper(Store& store, SweepFolders& folders, Queue& queue, DiskWatch& disk,
                         std::size_t kept_free)
    : store_(store), folders_(folders), queue_(queue), disk_(disk), kept_free_(kept_free) {
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
      log::error("maintenance of sweeps: {}", error.what());
    }
  }
}

void SweepKeeper::look_after_all(const std::stop_token& ends) {
  const std::vector<SweepEntry> sweeps = store_.unfinished_sweeps();
  std::erase_if(next_, [&](const auto& known) {
    return std::none_of(sweeps.begin(), sweeps.end(),
                        [&](const SweepEntry& sweep) { return sweep.id == known.first; });
  });
  for (const SweepEntry& sweep : sweeps) {
    if (ends.stop_requested()) return;
    try {
      look_after(sweep);
    } catch (const std::exception& error) {  // the others continue
      log::error("{}: {}", sweep.id, error.what());
    }
  }
}

/// Whether the job to be merged from its runs has ended already.
bool SweepKeeper::is_in_vain(const std::string& id) const {
  const auto job = store_.merged_from(id);
  return job && job->over() && job->state.state != State::done;
}

void SweepKeeper::look_after(const SweepEntry& sweep) {
  if (sweep.state == SweepStage::running && is_in_vain(sweep.id)) return cancel(sweep.id);
  if (sweep.state == SweepStage::running) return make_runs(sweep);
  cancel_runs(sweep.id);
  if (unfinished_of(store_.run_counts(sweep.id)) == 0) {
    end(sweep.id, SweepStage::cancelling, SweepStage::cancelled, {});
  }
}

/// Creates as many further runs as allowed, or ends the sweep.
void SweepKeeper::make_runs(const SweepEntry& sweep) {
  SweepFolders::FolderPtr folder;
  try {
    folder = folders_.open(sweep);
  } catch (const BadJob& bad) {
    return end(sweep.id, SweepStage::running, SweepStage::failed, bad.what());
  }
  const auto& runs = folder->plan().runs;
  const Counts counts = store_.run_counts(sweep.id);
  std::size_t& next = next_[sweep.id];
  if (all_of(counts) == runs.size()) {
    if (unfinished_of(counts) == 0) end(sweep.id, SweepStage::running, SweepStage::done, {});
    return;
  }
  const std::size_t room = queue_.room() - std::min(queue_.room(), kept_free_);
  const std::size_t waiting = std::min(most_waiting, unfinished_of(counts));
  const std::size_t most = disk_.is_low() ? 0 : std::min(room, most_waiting - waiting);
  std::vector<JobEntry> made;
  std::size_t place = next;
  store_.change([&](StoreChange& c) {
    const auto now = c.find_sweep(sweep.id);
    if (!now || now->state != SweepStage::running) return;
    for (; place < runs.size(); ++place) {
      const std::string id = folder->job_id(runs[place]);
      if (c.find_job(id)) continue;
      if (made.size() == most) return;
      JobEntry job;
      job.id = id;
      job.sweep = sweep.id;
      job.state.created = utc_now();
      take_spec(job, folder->plan().job_of(runs[place]));
      c.add(job);
      made.push_back(std::move(job));
    }
  });
  next = place;
  queue_.take_up(made);
}

void SweepKeeper::end(const std::string& id, SweepStage from, SweepStage to,
                      const std::string& error) {
  std::optional<SweepEntry> sweep;
  store_.change([&](StoreChange& c) {
    sweep = c.find_sweep(id);
    if (!sweep || sweep->state != from) return;
    sweep->state = to;
    sweep->finished = utc_now();
    sweep->error = error;
    c.put(*sweep);
  });
  if (sweep) folders_.note(*sweep);
  log::info("{}: {} {}", id, enum_name(to), error);
}

void SweepKeeper::cancel(const std::string& id) {
  SweepEntry sweep;
  store_.change([&](StoreChange& c) {
    sweep = checked(c.find_sweep(id));
    if (sweep.state == SweepStage::cancelled) return;
    if (is_over(sweep.state)) {
      throw Conflict(fmt::format("The sweep is {}.", enum_name(sweep.state)));
    }
    sweep.state = SweepStage::cancelling;
    c.put(sweep);
  });
  folders_.note(sweep);
  cancel_runs(id);
  notice();
}

/// Waiting runs first: otherwise they would start as running ones end.
void SweepKeeper::cancel_runs(const std::string& id) {
  if (unfinished_of(store_.run_counts(id)) == 0) return;
  const std::vector<JobEntry> runs = store_.runs(id);
  for (const bool begun : {false, true}) {
    for (const JobEntry& run : runs) {
      if (run.over() || run.cancel || run.begun != begun) continue;
      try {
        queue_.cancel(run.id);
      } catch (const std::exception& error) {  // it just ended, or is retried later
        log::debug("{}: {}", run.id, error.what());
      }
    }
  }
}

void SweepKeeper::remove(const std::string& id) {
  const SweepEntry sweep = checked(store_.find_sweep(id));
  if (!is_over(sweep.state)) {
    throw Conflict(fmt::format("The sweep is {}: only a sweep that is over can be removed.",
                               enum_name(sweep.state)));
  }
  std::vector<std::string> jobs;
  for (const JobEntry& run : store_.runs(id)) jobs.push_back(run.id);
  queue_.check_removable(jobs);
  // The sweep last: after a crash before, it can be removed again.
  constexpr std::size_t at_once = 100;  // blocks the queue
  for (std::size_t i = 0; i < jobs.size(); i += at_once) {
    const auto begin = jobs.begin() + static_cast<std::ptrdiff_t>(i);
    const auto n = std::min(at_once, jobs.size() - i);
    queue_.remove_all({begin, begin + static_cast<std::ptrdiff_t>(n)});
  }
  folders_.remove(id);
  store_.change([&](StoreChange& c) { c.remove_sweep(id); });
  log::info("{}: removed, with {} jobs", id, jobs.size());
}

}  // namespace lacuna
