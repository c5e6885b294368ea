#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>

namespace lacuna {

/// One thread per open connection. Thread-safe.
class ConnectionThreads {
 public:
  explicit ConnectionThreads(std::size_t most) : most_(most) {}
  ConnectionThreads(const ConnectionThreads&) = delete;
  ConnectionThreads& operator=(const ConnectionThreads&) = delete;
  /// Waits for all threads.
  ~ConnectionThreads();

  /// Starts `serve` on a new thread; waits first while `most` threads run.
  void start(std::function<void()> serve);
  /// Number of threads.
  std::size_t count() const;

 private:
  struct Task;
  static void* run(void* task);

  const std::size_t most_;
  mutable std::mutex mutex_;
  std::condition_variable ended_;
  std::size_t count_ = 0;
};

}  // namespace lacuna
