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
/// alone, and no job overtakes it. The store is the source of truth, and only the queue writes it,
/// except for new jobs; renderers write their end into their folders, and the queue copies it.
/// Requests are on disk before the call returns.
///
/// A transient error (may_pass()) fails no job. A job whose folder cannot be locked, read or
/// written stays queued, with its obstacle, and the queue pauses before it continues with the next
/// one; the pauses, per job and of the queue, grow with each error.
///
/// The calls that change a job take the `revision` that the client has read; empty: any. All throw
/// Changed, Conflict, and, if the request could not be stored, std::system_error; then nothing has
/// changed.
class Queue {
 public:
  /// `jobs`: the parent of the jobs' folders.
  Queue(Executor& executor, Store& store, std::filesystem::path jobs, DiskWatch& disk,
        QueueSettings settings);
  ~Queue() { stop(); }
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// Begins with the unfinished jobs of the store.
  void start();
  /// Stops all renderers and waits for them; their jobs continue after the next start(). Renderers
  /// on other machines continue, and that start() finds them.
  void stop();

  /// Number of further jobs that may be added.
  std::size_t room() const;
  /// Throws Full if there is no room.
  void check_room() const;
  /// Calls `notice` whenever a job is over; it must return quickly. Call before start().
  void on_over(std::function<void()> notice) { on_over_ = std::move(notice); }
  /// To be called when jobs were added to the store: makes their folders if possible.
  void take_up(const std::vector<JobEntry>& added);

  /// Holding a running job stops it, with a checkpoint.
  void change(const std::string& id, std::optional<int> priority, std::optional<bool> held,
              const std::string& revision = {});
  /// Ends a job; does nothing if it is cancelled already.
  void cancel(const std::string& id, const std::string& revision = {});
  /// Continues a failed or cancelled job from its checkpoint.
  void retry(const std::string& id, const std::string& revision = {});
  /// Continues a job that is over until a larger budget is spent. Throws BadJob if it is not
  /// larger.
  void extend(const std::string& id, const Budget& budget, const std::string& revision = {});
  /// Removes a job that is over, and its folder; not a run of an unfinished sweep.
  void remove(const std::string& id, const std::string& revision = {});
  /// Removes several jobs: all or, if one cannot be removed, none.
  void remove_all(const std::vector<std::string>& ids);
  /// Throws Conflict if one of them cannot be removed.
  void check_removable(const std::vector<std::string>& ids) const;

  /// Checks the disk: while its free space is low, nothing starts and all renderers stop.
  void look_at_disk();
  /// Reads the progress that the renderers have written meanwhile.
  void look_at_running();
  /// Whether renderers write through a network file system, where reading progress costs more.
  bool is_remote() const { return executor_.is_remote(); }
  /// Why waiting jobs do not start, as public text without file names; empty: no obstacle. Never
  /// waits for the disk.
  std::string obstacle() const;

  JobFolder folder(const std::string& id) const { return JobFolder(jobs_ / id); }

 private:
  using Clock = std::chrono::steady_clock;

  /// A job in a runner's hands.
  struct Work {
    std::string id;
    bool exclusive = false;
    StopSignal stop;
    int faults_of_all = 0;  // consecutive errors of the queue when its renderer started
    LiveState live;
  };
  using WorkPtr = std::shared_ptr<Work>;

  /// The pause of an unfinished job.
  struct Pause {
    Clock::time_point until{};
    int faults = 0;                // transient errors since its last progress
    std::optional<Attempt> ended;  // a renderer's end not yet classified
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

  // Guards the next four. Held while a request is stored, which orders requests and starts of
  // renderers.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, WorkPtr> work_;
  std::map<std::string, Pause> pauses_;
  bool exclusive_runs_ = false;
  mutable std::mutex faults_mutex_;   // guards the next three; never held during a wait
  Clock::time_point paused_until_{};  // nothing starts until then after a transient error
  int faults_ = 0;                    // consecutive
  std::string obstacle_;              // of the last error
  std::vector<std::jthread> runners_;
};

}  // namespace lacuna
