#pragma once

#include <condition_variable>
#include <cstddef>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>

#include "jobs/queue/disk_watch.h"
#include "jobs/queue/queue.h"
#include "jobs/queue/store.h"
#include "server/keeper/sweep_folders.h"

namespace lacuna {

/// Adds the runs of sweeps to the queue as jobs, a few at a time and in the plan's order, and
/// detects when a sweep is over. Stops the sweep of a job's shards with that job. Its state is in
/// the store: a run that is a job there is not created again, even after a restart.
class SweepKeeper {
 public:
  /// Maximum unfinished runs of one sweep in the queue: enough that the queue never waits for the
  /// next, and other jobs wait for no more than these.
  static constexpr std::size_t most_waiting = 32;

  /// `kept_free`: number of jobs in the queue's limit reserved for others. The references must
  /// outlive it.
  SweepKeeper(Store& store, SweepFolders& folders, Queue& queue, DiskWatch& disk,
              std::size_t kept_free);
  ~SweepKeeper() { stop(); }
  SweepKeeper(const SweepKeeper&) = delete;
  SweepKeeper& operator=(const SweepKeeper&) = delete;

  void start();
  void stop();
  /// Call after any change that may concern a sweep, from any thread, under any lock.
  void notice();

  /// Ends a sweep: cancels its unfinished runs and creates no more. On disk before it returns; does
  /// nothing if it is cancelled already. Throws Conflict and std::system_error.
  void cancel(const std::string& id);
  /// Removes a sweep that is over, and its jobs. Throws Conflict, with nothing removed yet, and
  /// std::system_error.
  void remove(const std::string& id);

 private:
  void run(const std::stop_token& ends);
  void look_after_all(const std::stop_token& ends);
  bool is_in_vain(const std::string& id) const;
  void look_after(const SweepEntry& sweep);
  void make_runs(const SweepEntry& sweep);
  void end(const std::string& id, SweepStage from, SweepStage to, const std::string& error);
  void cancel_runs(const std::string& id);

  Store& store_;
  SweepFolders& folders_;
  Queue& queue_;
  DiskWatch& disk_;
  const std::size_t kept_free_;
  // By sweep: all runs before this one, in the plan's order, are jobs. Used by its own thread only.
  std::map<std::string, std::size_t> next_;

  std::mutex signal_;  // guards all below; never held during a wait
  std::condition_variable_any changed_;
  bool noticed_ = false;
  std::jthread thread_;
};

}  // namespace lacuna
