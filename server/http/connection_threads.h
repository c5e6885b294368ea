#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>

namespace lacuna {

/// A thread for each connection, as long as it lasts. Thread-safe.
class ConnectionThreads {
 public:
  explicit ConnectionThreads(std::size_t most) : most_(most) {}
  ConnectionThreads(const ConnectionThreads&) = delete;
  ConnectionThreads& operator=(const ConnectionThreads&) = delete;
  /// Waits for the end of all.
  ~ConnectionThreads();

  /// Starts `serve` on a thread of its own; waits first while there are as many as there may be.
  void start(std::function<void()> serve);
  /// How many there are.
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
