#pragma once

#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/queue/queue.h"
#include "server/settings/queue_settings.h"
#include "server/tables/job_table.h"

namespace lacuna {

/// Periodic maintenance: reads the progress of renderers, finds folders added or removed by others,
/// checks the disk space, and removes outdated jobs.
class MaintenanceThread {
 public:
  MaintenanceThread(JobTable& table, Queue& queue, CareSettings settings);
  ~MaintenanceThread() { stop(); }
  MaintenanceThread(const MaintenanceThread&) = delete;
  MaintenanceThread& operator=(const MaintenanceThread&) = delete;

  void start();
  void stop();

 private:
  void run();
  void remove_old();

  JobTable& table_;
  Queue& queue_;
  const CareSettings settings_;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace lacuna
