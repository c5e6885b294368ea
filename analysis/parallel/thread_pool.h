#pragma once

#include <functional>
#include <memory>

namespace lacuna {

/// A fixed number of threads that treat denormal numbers as zero (Embree needs it for its speed,
/// and the same everywhere for the same bits).
class ThreadPool {
 public:
  /// `threads` 0: one for each core.
  explicit ThreadPool(int threads);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return threads_; }
  /// Runs `body(i)` for i in [0, n) on the pool's threads, in any order, and waits. The first
  /// exception is rethrown.
  void for_each(int n, const std::function<void(int)>& body) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  int threads_;
};

}  // namespace lacuna
