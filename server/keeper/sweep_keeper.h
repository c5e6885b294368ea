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

/// Feeds the runs of sweeps into the queue as jobs, a few at a time and in the plan's order, and
/// detects when a sweep is over. Stops the sweep of a job's shards with its job. Its state is in
/// the store: a run that is a job there is not created again, even after a restart.
class SweepKeeper {
 public:
  /// Runs of one sweep that are jobs and not over: the queue never has to wait for the next, and
  /// other people's jobs wait for no more than these.
  static constexpr std::size_t most_waiting = 32;

  /// `kept_free`: so much of the queue's room is left to other jobs. The references outlive it.
  SweepKeeper(Store& store, SweepFolders& folders, Queue& queue, DiskWatch& disk,
              std::size_t kept_free);
  ~SweepKeeper() { stop(); }
  SweepKeeper(const SweepKeeper&) = delete;
  SweepKeeper& operator=(const SweepKeeper&) = delete;

  void start();
  void stop();
  /// Call when something has changed that may concern a sweep; from any thread, under any lock.
  void notice();

  /// Stops a sweep for good: what is not over is cancelled, and no run is made any more. On disk
  /// before it returns; nothing happens if it is cancelled already. Throws Conflict and
  /// std::system_error.
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
  // Of a sweep: all runs before this one, in the plan's order, are jobs. Its own thread's.
  std::map<std::string, std::size_t> next_;

  std::mutex signal_;  // guards all below; nothing is waited for under it
  std::condition_variable_any changed_;
  bool noticed_ = false;
  std::jthread thread_;
};

}  // namespace lacuna
