#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace lacuna {

/// Deletes folders that take_folders_away() has renamed, on its own thread: deleting a job's dozen
/// files takes tens of milliseconds, for which no request should wait.
class Trash {
 public:
  /// remove_stale_folders() removes the rest at the next start of the service.
  Trash();
  Trash(const Trash&) = delete;
  Trash& operator=(const Trash&) = delete;

  void take(std::vector<std::filesystem::path> folders);

 private:
  void run(const std::stop_token& ends);

  std::mutex mutex_;  // guards all below
  std::condition_variable_any changed_;
  std::deque<std::filesystem::path> folders_;
  std::jthread thread_;
};

}  // namespace lacuna
