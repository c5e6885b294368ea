#pragma once

#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "server/queue/disk_watch.h"
#include "server/queue/queue.h"
#include "server/tables/job_table.h"
#include "server/tables/sweep_table.h"

namespace lacuna {

/// Feeds the runs of sweeps into the queue as jobs, a few at a time and in the plan's order, and
/// detects when a sweep is over. A sweep that cannot be read now is looked at again. Makes the
/// sweep of a job's shards if a crash, or somebody, has left the job without, and stops it with its
/// job. Its state is in the folders: a run that exists as a job is not created again, even after a
/// restart.
class SweepKeeper {
 public:
  /// Runs of one sweep that are jobs and not over: the queue never has to wait for the next, and
  /// other people's jobs wait for no more than these.
  static constexpr std::size_t most_waiting = 32;

  /// `kept_free`: so much of the queue's room is left to other jobs. The references outlive it.
  SweepKeeper(SweepTable& sweeps, JobTable& jobs, Queue& queue, DiskWatch& disk,
              std::size_t kept_free);
  ~SweepKeeper() { stop(); }
  SweepKeeper(const SweepKeeper&) = delete;
  SweepKeeper& operator=(const SweepKeeper&) = delete;

  void start();
  void stop();
  /// Call when something has changed that may concern a sweep; from any thread, under any lock.
  void notice();

  /// Stops a sweep for good: what is not over is cancelled, and no run is made any more. On disk
  /// before it returns; nothing happens if it is cancelled already. Throws Conflict, Unavailable
  /// and std::system_error.
  void cancel(const std::string& id);
  /// Removes a sweep that is over, and its jobs. Throws Conflict and Unavailable, with nothing
  /// removed yet, and std::system_error.
  void remove(const std::string& id);

 private:
  /// An unfinished sweep.
  struct Feed {
    std::shared_ptr<const SweepFolder> folder;
    std::size_t next = 0;  // all runs before this one, in the plan's order, are jobs
  };

  void run(const std::stop_token& ends);
  void look_after_all(const std::stop_token& ends);
  void make_missing();
  bool read_again(const std::string& id);
  bool is_in_vain(const std::string& id) const;
  bool look_after(const std::string& id);
  bool make_next(const std::string& id, Feed& feed);
  void make(const Feed& feed, const SweepRun& run);
  void cancel_runs(const std::string& id);
  SweepEntryPtr checked(const std::string& id) const;

  SweepTable& sweeps_;
  JobTable& jobs_;
  Queue& queue_;
  DiskWatch& disk_;
  const std::size_t kept_free_;

  // Used by its own thread only:
  std::map<std::string, Feed> feeds_;
  std::string last_created_;  // of the run made last
  // Held while a run is made and while it is decided that none is made any more.
  std::mutex mutex_;

  std::mutex signal_;  // guards all below; nothing is waited for under it
  std::condition_variable_any changed_;
  bool noticed_ = false;
  std::jthread thread_;
};

}  // namespace lacuna
