#pragma once

#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "jobs/queue/queue.h"
#include "server/settings/care_settings.h"

namespace lacuna {

/// Periodic maintenance: reads the progress of renderers, checks the disk space, removes outdated
/// jobs and the temporary files of killed processes.
class MaintenanceThread {
 public:
  MaintenanceThread(const Store& store, Queue& queue, DataRoot data, CareSettings settings);
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

  const Store& store_;
  Queue& queue_;
  const DataRoot data_;
  const CareSettings settings_;
  std::vector<std::string> jobs_to_tidy_;

  std::mutex mutex_;
  std::condition_variable_any ended_;
  std::jthread thread_;
};

}  // namespace lacuna
