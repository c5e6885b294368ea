#include "jobs/slurm/slurm_watch.h"

#include <fmt/format.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <system_error>
#include <utility>

#include "base/log/log.h"
#include "jobs/store/exit_code.h"

namespace lacuna {
namespace {

using Phase = SlurmJob::Phase;

/// "Slurm job 17: TIMEOUT"
std::string slurm_words(const std::optional<SlurmJob>& last, bool known_now) {
  if (!last) return "Slurm has no record of it";
  const std::string name = fmt::format("Slurm job {}", last->id);
  if (!known_now) return name + " is no longer known";
  const bool reason = !last->reason.empty() && last->reason != "None";
  return fmt::format("{}: {}{}", name, last->state, reason ? " (" + last->reason + ")" : "");
}

/// Whether the folder records the end of a renderer.
bool is_told(const JobFolder& folder) {
  try {
    return is_terminal(folder.read_state().state);
  } catch (const std::exception&) {  // it lags behind, or is damaged, which the queue detects
    return false;
  }
}

}  // namespace

Ending slurm_ending(std::optional<int> code, const std::optional<SlurmJob>& last, bool known_now) {
  const std::string words = slurm_words(last, known_now);
  const std::string state = known_now && last ? last->state : "";
  constexpr int signals = 128;
  const bool stopped = !code || *code == exit_interrupted || *code > signals;
  if (state == "CANCELLED" && stopped) {
    return {Ending::Kind::refused, code.value_or(0), "it was cancelled in Slurm; " + words};
  }
  if (state == "OUT_OF_MEMORY") {
    return {Ending::Kind::out_of_memory, code.value_or(signals + SIGKILL),
            "renderer ran out of memory: " + words};
  }
  if (code && *code == exit_memory) {
    return {Ending::Kind::out_of_memory, *code, "renderer ran out of memory; " + words};
  }
  if (code && *code == signals + SIGTERM) {
    return {Ending::Kind::lost, *code, "renderer was stopped before it began; " + words};
  }
  if (code && *code > signals) {
    const int number = *code - signals;
    return {Ending::Kind::killed, number,
            fmt::format("renderer ended by signal {} ({})", number, ::strsignal(number))};
  }
  if (code) {
    return {Ending::Kind::exited, *code, fmt::format("renderer ended with exit code {}", *code)};
  }
  const bool told = state == "TIMEOUT" || state == "PREEMPTED" || state == "NODE_FAIL" ||
                    state == "BOOT_FAIL" || state == "DEADLINE";
  return {Ending::Kind::lost, 0,
          told ? words
               : "renderer left no exit code, or its node cannot access the data folder; " + words};
}

SlurmWatch::SlurmWatch(const SlurmPrograms& programs, std::chrono::milliseconds poll)
    : programs_(programs),
      poll_(poll),
      thread_([this](const std::stop_token& ends) { run(ends); }) {}

SlurmWatch::~SlurmWatch() {
  thread_.request_stop();
  thread_.join();
}

SlurmWatch::Guest::Guest(SlurmWatch& watch, const JobFolder& folder, const Submission& submission,
                         std::function<void(const std::string&)> place)
    : watch_(watch),
      watched_(new SlurmWatched{folder, submission, std::move(place),
                                FileHandle(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))}) {
  if (!watched_->event) throw std::system_error(errno, std::generic_category(), "eventfd");
  {
    const std::lock_guard lock(watch_.mutex_);
    watch_.watched_.push_back(watched_);
    watch_.note_place(*watched_);
  }
  watch_.changed_.notify_all();
}

SlurmWatch::Guest::~Guest() {
  const std::lock_guard lock(watch_.mutex_);
  watch_.watched_.remove(watched_);
}

SlurmWatch::View SlurmWatch::Guest::look() const {
  const std::lock_guard lock(watch_.mutex_);
  eventfd_t ignored = 0;
  ::eventfd_read(watched_->event.get(), &ignored);
  return {watched_->submission, watched_->last, watched_->ending, watched_->unknown,
          std::exchange(watched_->nice, std::nullopt)};
}

void SlurmWatch::set_nice(const JobFolder& folder, int nice) {
  const std::lock_guard lock(mutex_);
  for (const WatchedPtr& watched : watched_) {
    if (watched->folder.dir() != folder.dir()) continue;
    watched->nice = nice;
    ::eventfd_write(watched->event.get(), 1);
  }
}

std::string SlurmWatch::obstacle() const {
  const std::lock_guard lock(mutex_);
  return watched_.empty() ? "" : obstacle_;
}

void SlurmWatch::run(const std::stop_token& ends) {
  const auto tick = std::min(poll_, std::chrono::milliseconds(1000));
  auto next_list = Clock::now();
  while (!ends.stop_requested()) {
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, ends, [&] { return !watched_.empty(); });
      changed_.wait_for(lock, ends, tick, [] { return false; });
    }
    if (ends.stop_requested()) return;
    look_at_folders();
    if (Clock::now() < next_list) continue;
    next_list = Clock::now() + poll_;
    list();
  }
}

/// Reads ends of renderers from the folders.
void SlurmWatch::look_at_folders() {
  std::list<WatchedPtr> all;
  {
    const std::lock_guard lock(mutex_);
    all = watched_;
  }
  for (const WatchedPtr& watched : all) {
    // The name never changes while it is watched.
    const auto code = read_submission_exit(watched->folder, watched->submission.name);
    if (!code || !is_told(watched->folder)) continue;
    const std::lock_guard lock(mutex_);
    if (watched->ending) continue;
    watched->ending = slurm_ending(code, watched->last, true);
    ::eventfd_write(watched->event.get(), 1);
  }
}

void SlurmWatch::list() {
  const auto began = Clock::now();
  std::vector<SlurmJob> jobs;
  std::string failed;
  try {
    jobs = programs_.list();
  } catch (const std::exception& error) {
    failed = error.what();
  }
  std::map<std::string_view, const SlurmJob*> by_name;
  for (const SlurmJob& job : jobs) by_name[job.name] = &job;
  std::vector<WatchedPtr> to_ask;
  {
    const std::lock_guard lock(mutex_);
    if (failed != obstacle_ && !failed.empty())
      log::warn("Slurm's jobs cannot be listed: {}", failed);
    obstacle_ = failed;
    if (!failed.empty()) return;
    for (const WatchedPtr& watched : watched_) {
      if (watched->since > began || watched->ending) continue;
      const auto found = by_name.find(watched->submission.name);
      if (found != by_name.end()) {
        watched->last = *found->second;
        watched->submission.job = found->second->id;
      }
      const bool listed = found != by_name.end();
      judge(*watched, listed);
      if (!listed && watched->gone >= slurm_listings_to_believe && !watched->asked_accounts) {
        to_ask.push_back(watched);
      }
    }
  }
  if (!to_ask.empty()) account(to_ask);
}

/// Looks up jobs that squeue does not list in the accounting.
void SlurmWatch::account(const std::vector<WatchedPtr>& whom) {
  std::vector<std::string> names;
  names.reserve(whom.size());
  for (const WatchedPtr& watched : whom) names.push_back(watched->submission.name);
  const std::vector<SlurmJob> jobs = programs_.account(names);
  const std::lock_guard lock(mutex_);
  for (const WatchedPtr& watched : whom) {
    watched->asked_accounts = true;
    for (const SlurmJob& job : jobs) {
      if (job.name == watched->submission.name) watched->last = job;
    }
    if (watched->last) watched->submission.job = watched->last->id;
  }
}

/// Called after a listing, under the lock.
void SlurmWatch::judge(SlurmWatched& watched, bool listed) {
  note_place(watched);
  const bool over = !listed || watched.last->phase == Phase::over;
  if (!over) {
    watched.gone = 0;
    watched.gone_since.reset();
    ::eventfd_write(watched.event.get(), 1);
    return;
  }
  if (!watched.gone_since) watched.gone_since = Clock::now();
  if (++watched.gone < slurm_listings_to_believe) return;
  if (!listed && !watched.asked_accounts) return;
  const auto code = read_submission_exit(watched.folder, watched.submission.name);
  const bool never = !code && !watched.last && watched.submission.job == 0;
  const bool lags = Clock::now() - *watched.gone_since < slurm_intervals_to_lag * poll_;
  const bool agrees = code && (*code != exit_done || is_told(watched.folder));
  if (lags && !agrees && !never) return;
  const bool known_now = watched.last && watched.last->phase == Phase::over;
  if (never) {
    watched.unknown = true;
  } else {
    watched.ending = slurm_ending(code, watched.last, known_now);
  }
  ::eventfd_write(watched.event.get(), 1);
}

/// Only under the lock.
void SlurmWatch::note_place(SlurmWatched& watched) {
  if (!watched.place) return;
  const std::int64_t job = watched.submission.job;
  if (job == 0) return watched.place("Slurm: it is being submitted");
  std::string text = fmt::format("Slurm job {}", job);
  if (watched.last && watched.last->phase == Phase::waits) {
    text += fmt::format(" waits: {}", watched.last->reason);
  } else if (watched.last && watched.last->phase == Phase::runs) {
    text += fmt::format(" on {}", watched.last->nodes);
  }
  watched.place(text);
}

}  // namespace lacuna
