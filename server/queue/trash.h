#pragma once

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <thread>
#include <vector>

namespace lacuna {

/// Deletes folders already renamed by take_folders_away() on its own thread: deleting a job's dozen
/// files takes tens of milliseconds, for which no request should wait.
class Trash {
 public:
  Trash();
  ~Trash() { stop(); }
  Trash(const Trash&) = delete;
  Trash& operator=(const Trash&) = delete;

  void take(std::vector<std::filesystem::path> folders);
  /// What is left then, remove_stale_folders() finds when the service starts again.
  void stop();

 private:
  void run();

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  std::deque<std::filesystem::path> folders_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace lacuna
