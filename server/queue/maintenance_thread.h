#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "server/queue/queue.h"
#include "server/settings/queue_settings.h"
#include "server/tables/job_table.h"

namespace lacuna {

/// Periodic maintenance: reads the progress of renderers, finds folders added or removed by others,
/// checks the disk space, removes outdated jobs, and saves the
/// index of jobs.
class MaintenanceThread {
 public:
  /// `look`: called about once a second, too.
  MaintenanceThread(JobTable& table, Queue& queue, CareSettings settings,
                    std::function<void()> look);
  ~MaintenanceThread() { stop(); }
  MaintenanceThread(const MaintenanceThread&) = delete;
  MaintenanceThread& operator=(const MaintenanceThread&) = delete;

  void start();
  void stop();

 private:
  void run(const std::stop_token& ends);
  void do_round(int number);
  void remove_old();
  void list_folders();
  void tidy_some();

  JobTable& table_;
  Queue& queue_;
  const CareSettings settings_;
  const std::function<void()> look_;
  std::vector<EntryPtr> jobs_to_tidy_;  // the last first

  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread thread_;
};

}  // namespace lacuna
