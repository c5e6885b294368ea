#pragma once

#include <condition_variable>
#include <filesystem>
#include <mutex>
#include <thread>

#include "server/job_table.h"
#include "server/queue.h"
#include "server/settings.h"

namespace lacuna {

/// Bytes that may still be written where `folder` lies. Throws std::system_error.
std::uint64_t free_bytes(const std::filesystem::path& folder);

/// Looks after what changes by itself while the service runs: what renderers write, folders that
/// come and go by other hands, room on the disk, and old jobs that need not be kept.
class Caretaker {
 public:
  Caretaker(DataRoot data, JobTable& table, Queue& queue, CareSettings settings);
  ~Caretaker() { stop(); }
  Caretaker(const Caretaker&) = delete;
  Caretaker& operator=(const Caretaker&) = delete;

  /// Looks at the disk at once, and begins.
  void start();
  void stop();

 private:
  void run();
  void look_at_disk();
  void remove_old();

  const DataRoot data_;
  JobTable& table_;
  Queue& queue_;
  const CareSettings settings_;
  bool disk_low_ = false;

  std::mutex mutex_;
  std::condition_variable changed_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace lacuna
