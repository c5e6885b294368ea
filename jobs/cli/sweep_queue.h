#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jobs/cli/terminal.h"
#include "jobs/queue/disk_watch.h"
#include "jobs/queue/queue.h"
#include "jobs/queue/store.h"
#include "jobs/slurm/slurm_settings.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// How `lacuna sweep` renders.
struct SweepQueueSettings {
  int at_a_time = 1;
  int threads = -1;                         ///< of each renderer; -1: the job's own
  std::optional<SlurmSettings> slurm = {};  ///< none: renderers are processes of this machine
};

/// Renders runs of a sweep as a service renders jobs. Its database is in memory and the state of a
/// run is only in its folder, so that the tasks of a job array can share a sweep.
class SweepQueue {
 public:
  SweepQueue(const SweepFolder& sweep, const SweepQueueSettings& settings, Terminal& terminal);
  SweepQueue(const SweepQueue&) = delete;
  SweepQueue& operator=(const SweepQueue&) = delete;

  /// Renders these runs (by index from 1, with their states) until all are over, `interrupted`
  /// returns true, or an obstacle has lasted a minute. Returns an exit code.
  int run(const std::map<std::size_t, JobState>& left, const std::function<bool()>& interrupted);

 private:
  using Clock = std::chrono::steady_clock;

  struct LogLines;
  void add(const std::map<std::size_t, JobState>& left);
  void take_events();
  void take(const JobEntry& entry);
  void report(const JobEntry& entry);  // for a run that is over
  void print_log();
  void look_after();
  void show();
  bool gives_up() const;

  const SweepFolder& sweep_;
  Terminal& terminal_;
  const bool remote_;
  const int at_a_time_;
  const std::shared_ptr<LogLines> log_;
  Store store_;
  const std::unique_ptr<Executor> executor_;
  DiskWatch disk_;
  Queue queue_;

  std::map<std::string, const SweepRun*> open_;  // by name
  std::int64_t seen_ = 0;                        // the last event
  std::size_t all_ = 0, finished_ = 0, failed_ = 0;
  std::string obstacle_;                    // of a run
  std::string told_;                        // the last reported obstacle of all runs
  std::optional<Clock::time_point> since_;  // when an obstacle appeared; none: runs progress
  const Clock::time_point began_ = Clock::now();
  Clock::time_point next_look_, next_show_;
};

}  // namespace lacuna
