#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "jobs/queue/disk_watch.h"
#include "jobs/queue/executor.h"
#include "jobs/queue/exit_classification.h"
#include "jobs/queue/queue_settings.h"
#include "jobs/queue/store.h"
#include "jobs/queue/trash.h"

namespace lacuna {

/// The request is not possible in the job's present state.
class Conflict : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// The job has changed since the client read it.
class Changed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// No more jobs may wait.
class Full : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Renders the jobs of a store: by priority, then first come, first served; an exclusive job runs
/// alone, and no job overtakes it. The store is the source of truth and this its only writer but
/// for what is added; renderers write into their folders, and what they say of their end is taken
/// over. Requests are on disk before the call returns.
///
/// A fault that may pass (may_pass()) costs no job. A job whose folder cannot be locked, read or
/// written stays in the line, with its obstacle, and the queue pauses before it continues with the
/// next one; the pauses grow with each fault, of a job and of all.
///
/// The calls that change a job take the `revision` that the client has read; empty: any. All throw
/// Changed, Conflict, and std::system_error if the request could not be stored: then nothing has
/// changed.
class Queue {
 public:
  /// `jobs`: where the folders of the jobs lie.
  Queue(Executor& executor, Store& store, std::filesystem::path jobs, DiskWatch& disk,
        QueueSettings settings);
  ~Queue() { stop(); }
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// Begins with the unfinished jobs of the store.
  void start();
  /// Asks all renderers to stop and waits for them; their jobs go on after the next start().
  /// Renderers on other machines go on, and that start() finds them.
  void stop();

  /// How many more jobs may wait or run.
  std::size_t room() const;
  /// Throws Full if there is no room.
  void check_room() const;
  /// Calls `notice` whenever a job is over: it may only take note. Before start().
  void on_over(std::function<void()> notice) { on_over_ = std::move(notice); }
  /// Jobs were added to the store: makes their folders, as far as that can be done now.
  void take_up(const std::vector<JobEntry>& added);

  /// A running job that is held is stopped, with its checkpoint.
  void change(const std::string& id, std::optional<int> priority, std::optional<bool> held,
              const std::string& revision = {});
  /// Stops a job for good; nothing happens if it is cancelled already.
  void cancel(const std::string& id, const std::string& revision = {});
  /// A failed or cancelled job goes on from its checkpoint.
  void retry(const std::string& id, const std::string& revision = {});
  /// A job that is over goes on until a larger budget is spent. Throws BadJob if it is no larger.
  void extend(const std::string& id, const Budget& budget, const std::string& revision = {});
  /// Removes a job that is over, and its folder: none of a sweep that is not over.
  void remove(const std::string& id, const std::string& revision = {});
  /// The same of many at once: all of them or, if one cannot be, none.
  void remove_all(const std::vector<std::string>& ids);
  /// Throws Conflict if one of them cannot be removed.
  void check_removable(const std::vector<std::string>& ids) const;

  /// While there is too little room on the disk, nothing starts and all renderers stop.
  void look_at_disk();
  /// Takes over what the renderers have written about their jobs meanwhile.
  void look_at_running();
  /// Its renderers write through a file system of many machines, where looking costs more.
  bool is_remote() const { return executor_.is_remote(); }
  /// Why the jobs that wait do not go on, for everybody: names no file. Empty: nothing keeps them.
  /// Never waits for the disk.
  std::string obstacle() const;

  JobFolder folder(const std::string& id) const { return JobFolder(jobs_ / id); }

 private:
  using Clock = std::chrono::steady_clock;

  /// A job that a runner has.
  struct Work {
    std::string id;
    bool exclusive = false;
    StopSignal stop;
    int faults_of_all = 0;  // of the queue in a row, when its renderer started
    LiveState live;
  };
  using WorkPtr = std::shared_ptr<Work>;

  /// What keeps a job waiting that is unfinished.
  struct Pause {
    Clock::time_point until{};
    int faults = 0;                // that may pass, since its last progress
    std::optional<Attempt> ended;  // a renderer that is not judged yet
  };

  void run(const std::stop_token& ends);
  WorkPtr take(const std::stop_token& ends);
  std::optional<JobEntry> first_ready(Clock::time_point& look_again) const;
  bool waits_for_shards(const JobEntry& entry) const;
  void attend(Work& work, const std::stop_token& ends);
  std::optional<Attempt> render(Work& work, const JobEntry& entry);
  bool may_render(Work& work, Attempt& attempt);
  void judge(Work& work, Attempt attempt, const std::stop_token& ends);
  void settle(Work& work, Attempt& attempt);
  void note_start(Work& work, pid_t pid);
  void update_live(Work& work, const std::function<void(LiveState&)>& change);
  void look_at(Work& work);
  void postpone(const std::string& id, const std::exception& error);
  void note_obstacle(const std::string& id, const std::string& what, const std::string& for_all);
  void note_end(const JobEntry& entry) const;
  void give_up(const std::string& id, const std::string& reason);
  bool wait_until_free(const JobEntry& entry, const std::stop_token& ends);
  std::optional<JobFolder::Lock> try_folder(const JobEntry& entry) const;
  void make_folder(const JobEntry& entry) const;
  JobEntry reopened(JobEntry entry) const;
  void check_all_removable(const std::vector<std::string>& ids) const;
  void take_away(const std::vector<std::string>& ids);

  Executor& executor_;
  Store& store_;
  const std::filesystem::path jobs_;
  DiskWatch& disk_;
  const QueueSettings settings_;
  std::function<void()> on_over_ = [] {};
  Trash trash_;

  // Guards the next four, and is held while a request is stored, so that a request and the start of
  // a renderer have one order.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, WorkPtr> work_;
  std::map<std::string, Pause> pauses_;
  bool exclusive_runs_ = false;
  mutable std::mutex faults_mutex_;   // guards the next three; nothing is waited for under it
  Clock::time_point paused_until_{};  // after a fault that may pass nothing starts until then
  int faults_ = 0;                    // in a row
  std::string obstacle_;              // the last of them
  std::vector<std::jthread> runners_;
};

}  // namespace lacuna
