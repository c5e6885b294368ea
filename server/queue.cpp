#include "server/queue.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "server/child_process.h"

namespace lacuna {
namespace {

// How often a folder that another renderer holds is looked at again.
constexpr std::chrono::milliseconds look_again{500};

std::int64_t iterations_of(const JobFolder& f) {
  const auto progress = f.read_progress();
  return progress ? progress->iteration : 0;
}

JobState cancelled(JobState state) { return ended(std::move(state), State::cancelled, utc_now()); }

}  // namespace

Queue::Queue(DataRoot data, Executor& executor, QueueSettings settings)
    : data_(std::move(data)), executor_(executor), settings_(settings) {}

void Queue::start() {
  std::vector<std::pair<std::string, JobFolder>> unfinished;  // ids tell the order only to a second
  for (const JobFolder& f : list_jobs(data_.jobs())) {
    try {
      const JobState state = f.read_state();
      if (!is_terminal(state.state)) unfinished.emplace_back(state.created, f);
    } catch (const std::exception& error) {
      spdlog::error("{} is left alone: {}", f.id(), error.what());
    }
  }
  std::stable_sort(unfinished.begin(), unfinished.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [created, f] : unfinished) {
    try {
      rebuild(f);
    } catch (const std::exception& error) {
      spdlog::error("{} is left alone: {}", f.id(), error.what());
    }
  }
  for (int i = 0; i < settings_.children; ++i) runners_.emplace_back([this] { run(); });
}

void Queue::rebuild(const JobFolder& f) {
  JobState state = f.read_state();
  const bool cancel = state.state == State::cancelling;
  // Held: a renderer of an earlier service is still ending. A runner will wait for it.
  if (const auto free = f.try_lock()) {
    if (cancel) return f.write_state(cancelled(state));
    if (state.state != State::queued) f.write_state(queued(std::move(state)));
  }
  add(f);
  if (!cancel) return;
  const std::lock_guard lock(mutex_);
  work_.at(f.id())->cancel = true;
}

void Queue::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
    for (const auto& [id, work] : work_) work->stop.request();
  }
  changed_.notify_all();
  for (std::thread& runner : runners_) runner.join();
  runners_.clear();
}

void Queue::add(const JobFolder& f) {
  const auto work = std::make_shared<Work>();
  {
    const std::lock_guard lock(mutex_);
    work_.emplace(f.id(), work);
    waiting_.push_back(f.id());
  }
  changed_.notify_one();
}

Queue::Cancel Queue::cancel(const JobFolder& f) {
  {
    const std::lock_guard lock(mutex_);
    const auto found = work_.find(f.id());
    if (found == work_.end()) return Cancel::over;
    found->second->cancel = true;
    const auto place = std::find(waiting_.begin(), waiting_.end(), f.id());
    if (place == waiting_.end()) {
      found->second->stop.request();
      return Cancel::cancelling;
    }
    waiting_.erase(place);  // from here on no runner takes it
  }
  try {
    if (withdraw(f)) return Cancel::cancelled;
  } catch (const std::exception& error) {
    spdlog::error("{}: {}", f.id(), error.what());
  }
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_front(f.id());
  }
  changed_.notify_one();
  return Cancel::cancelling;
}

/// Ends a job that no runner has. False: a renderer of somebody else still holds its folder.
bool Queue::withdraw(const JobFolder& f) {
  const std::lock_guard no_forks(fork_mutex());
  const auto free = f.try_lock();
  if (!free) return false;
  const JobState state = f.read_state();
  if (!is_terminal(state.state)) save(f, cancelled(state));
  const std::lock_guard lock(mutex_);
  work_.erase(f.id());
  return true;
}

bool Queue::holds(const JobFolder& f) const {
  const std::lock_guard lock(mutex_);
  return work_.contains(f.id());
}

JobState Queue::state(const JobFolder& f) const {
  bool cancelling = false;
  {
    const std::lock_guard lock(mutex_);
    const auto unsaved = unsaved_.find(f.id());
    if (unsaved != unsaved_.end()) return unsaved->second;
    const auto work = work_.find(f.id());
    cancelling = work != work_.end() && work->second->cancel;
  }
  JobState state = f.read_state();
  if (cancelling && !is_terminal(state.state)) state.state = State::cancelling;
  return state;
}

void Queue::run() {
  while (const auto id = take()) {
    std::shared_ptr<Work> work;
    {
      const std::lock_guard lock(mutex_);
      work = work_.at(*id);
    }
    try {
      attend(*id, *work);
    } catch (const std::exception& error) {
      spdlog::error("{} is given up: {}", *id, error.what());
      const std::lock_guard lock(mutex_);
      work_.erase(*id);
    }
  }
}

std::optional<std::string> Queue::take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return stopping_ || !waiting_.empty(); });
  if (stopping_) return std::nullopt;
  std::string id = std::move(waiting_.front());
  waiting_.pop_front();
  return id;
}

/// False: the service ends first.
bool Queue::wait_until_free(const JobFolder& f) {
  const auto is_free = [&] {
    const std::lock_guard no_forks(fork_mutex());
    return f.try_lock().has_value();
  };
  while (!is_free()) {
    std::unique_lock lock(mutex_);
    if (changed_.wait_for(lock, look_again, [&] { return stopping_; })) return false;
  }
  return true;
}

void Queue::attend(const std::string& id, Work& work) {
  const JobFolder f = folder(id);
  if (!wait_until_free(f)) return;
  Attempt attempt{.before = f.read_state(), .after = {}, .ending = {}, .crashes = work.crashes};
  bool cancel = false;
  {
    const std::lock_guard lock(mutex_);
    cancel = work.cancel;
    if (is_terminal(attempt.before.state)) work_.erase(id);
  }
  if (is_terminal(attempt.before.state)) return;
  if (cancel) {
    withdraw(f);
    return;
  }
  attempt.iteration_before = iterations_of(f);
  spdlog::info("{}: a renderer is started", id);
  attempt.ending = executor_.run(f, work.stop, {});
  spdlog::info("{}: {}", id, attempt.ending.reason);
  try {
    attempt.after = f.read_state();
  } catch (const std::runtime_error& error) {
    spdlog::error("{}: {}", id, error.what());
    attempt.after = attempt.before;
  }
  attempt.iteration_after = iterations_of(f);
  settle(id, work, std::move(attempt));
}

void Queue::settle(const std::string& id, Work& work, Attempt attempt) {
  for (;;) {
    {
      const std::lock_guard lock(mutex_);
      attempt.cancel = work.cancel;
      attempt.stopped = stopping_;
    }
    const Verdict verdict = judge(attempt, settings_.max_attempts, utc_now());
    save(folder(id), verdict.state);
    const std::lock_guard lock(mutex_);
    const bool over = is_terminal(verdict.state.state);
    if (!over && work.cancel != attempt.cancel) continue;  // asked for while it was written
    if (verdict.crashed) ++work.crashes;
    if (over) {
      work_.erase(id);
    } else {
      waiting_.push_back(id);
      changed_.notify_one();
    }
    return;
  }
}

void Queue::save(const JobFolder& f, const JobState& state) {
  try {
    f.write_state(state);
    const std::lock_guard lock(mutex_);
    unsaved_.erase(f.id());
  } catch (const std::exception& error) {
    spdlog::error("{}: its state could not be saved: {}", f.id(), error.what());
    const std::lock_guard lock(mutex_);
    unsaved_[f.id()] = state;
  }
}

}  // namespace lacuna
