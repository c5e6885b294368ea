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
#include <tuple>
#include <vector>

#include "jobs/store/job_folder.h"
#include "server/queue/disk_watch.h"
#include "server/queue/executor.h"
#include "server/queue/exit_classification.h"
#include "server/queue/trash.h"
#include "server/settings/queue_settings.h"
#include "server/tables/job_table.h"

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
/// It is not possible now, and may be soon.
class Unavailable : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};
/// No more jobs may wait.
class Full : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The waiting and the running jobs: by priority, then first come, first served; an exclusive job
/// runs alone, and no job overtakes it. The folders are the source of truth, from which the queue
/// can be rebuilt. While a renderer runs, it owns its job's state.json; before and after, the queue
/// does. Requests are on disk before the call returns.
///
/// A fault that may pass (may_pass()) costs no job. A job whose folder cannot be locked, read or
/// written stays in the line, with the obstacle in the table, and the queue pauses before it
/// continues with the next one; the pauses grow with each fault, of a job and of all.
///
/// The calls that change a job take the `revision` that the client has read; empty: any. All throw
/// Changed, Conflict, Unavailable, and std::system_error if the request could not be stored: then
/// nothing has changed.
class Queue {
 public:
  Queue(Executor& executor, JobTable& table, DiskWatch& disk, QueueSettings settings);
  ~Queue() { stop(); }
  Queue(const Queue&) = delete;
  Queue& operator=(const Queue&) = delete;

  /// Puts every unfinished job of the table in the line again, and begins.
  void start();
  /// Asks all renderers to stop and waits for them; their jobs go on after the next start().
  /// Renderers that are not of this service's machine run on, and that start() finds them.
  void stop();

  /// How many more jobs may wait or run.
  std::size_t room() const;
  /// Throws Full if there is no room.
  void check_room() const;
  /// Calls `notice` whenever a job is over: under the queue's lock, so that it may only take note.
  /// Before start().
  void on_over(std::function<void()> notice) { on_over_ = std::move(notice); }
  /// A new job, whose folder is complete on disk.
  EntryPtr add(const std::string& id);
  /// Puts the unfinished jobs of the table that it has not seen yet in the line: folders that
  /// somebody else has made.
  void adopt();

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
  /// The same of one that need not be kept: throws Conflict unless its folder says that it is over.
  void remove_outdated(const std::string& id);
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
  /// Tries once more to write the states that could not be written.
  void save_pending();
  /// Why the jobs that wait do not go on, for everybody: names no file. Empty: nothing keeps them.
  std::string obstacle() const;

 private:
  using Clock = std::chrono::steady_clock;
  // Whether it has to be submitted first, -priority, creation, id.
  using QueueKey = std::tuple<bool, int, std::string, std::string>;

  /// A job that is not over.
  struct Work {
    std::string id;
    std::string created;
    bool exclusive = false;
    JobControl control;
    Clock::time_point not_before{};
    int faults = 0;                     // that may pass, since its last progress
    int faults_of_all = 0;              // of the queue in a row, when its renderer started
    std::optional<QueueKey> queue_key;  // in the line
    std::shared_ptr<StopSignal> stop;   // a runner has it
    bool stopped_for_disk = false;
    std::optional<Attempt> ended;  // a renderer that is not judged yet
  };
  using WorkPtr = std::shared_ptr<Work>;

  /// The folder of a job that no runner has, for ourselves, and what its state.json says.
  struct Claim {
    JobFolder::Lock lock;
    JobState state;
  };

  void run(const std::stop_token& ends);
  WorkPtr take(const std::stop_token& ends);
  WorkPtr first_ready(Clock::time_point& look_again) const;
  void attend(Work& work, const std::stop_token& ends);
  bool render(Work& work);
  bool may_render(Work& work, Attempt& attempt);
  void read_at_last(const std::string& id);
  void hand_back(const WorkPtr& work);
  void postpone(Work& work, const std::exception& error);
  void note_obstacle(Work& work, const std::string& what, const std::string& for_all);
  bool waits_for_shards(const Work& work) const;
  bool wait_until_free(const Work& work, const std::stop_token& ends);
  void note_start(Work& work, pid_t pid);
  void settle(Work& work, Attempt attempt, const std::stop_token& ends);
  void resume(Work& work);
  void give_up(const std::string& id, const std::string& reason);
  void enter(const std::string& id);
  void place(const JobEntry& entry, Work& work);
  WorkPtr open(const JobEntry& entry, const JobControl& control);
  void line_up(Work& work);
  void leave_line(Work& work);
  std::optional<JobFolder::Lock> try_folder(const Work& work) const;
  std::optional<Claim> claim(const Work& work) const;
  void commit(Work& work, const JobState& before, State how);
  bool withdraw(Work& work, State how);
  void write_control(Work& work, const JobControl& control);
  void write_state(const std::string& id, const JobState& state, bool over);
  void forget(const std::string& id);
  JobState stored_state(const std::string& id) const;
  Work& reopen(const EntryPtr& entry);
  EntryPtr checked(const std::string& id, const std::string& revision) const;
  void check_all_removable(const std::vector<std::string>& ids) const;
  void take_away(const std::vector<std::string>& ids);
  bool is_over_on_disk(const std::string& id) const;

  Executor& executor_;
  JobTable& table_;
  DiskWatch& disk_;
  const QueueSettings settings_;
  std::function<void()> on_over_ = [] {};
  Trash trash_;

  // Guards all below, and is held while a decision is written to disk, so that decisions and what
  // is stored of them have one order. Nothing else is waited for under it.
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::map<std::string, WorkPtr> work_;
  std::set<QueueKey> line_;
  std::map<std::string, JobState> unsaved_;  // states that could not be written (disk full)
  int running_ = 0;
  bool exclusive_runs_ = false;
  // After a fault that may pass nothing starts until then.
  Clock::time_point paused_until_{};
  int faults_ = 0;        // in a row
  std::string obstacle_;  // the last of them
  std::vector<std::jthread> runners_;
};

}  // namespace lacuna
