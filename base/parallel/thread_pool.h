#pragma once

#include <functional>
#include <memory>

#include "base/parallel/stop.h"
#include "base/parallel/work_log.h"

namespace lacuna {

/// A fixed number of threads that treat denormal numbers as zero: Embree needs it for speed, and
/// all threads must agree to give the same bits.
class ThreadPool {
 public:
  /// `threads` 0: one for each core. `stop` is called by several threads; true abandons all work;
  /// empty: never.
  explicit ThreadPool(int threads, std::function<bool()> stop = {});
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return threads_; }
  /// Whether stop() returns true.
  bool stopped() const { return stop_ && stop_(); }
  /// Throws Stopped if stopped(). For serial loops of more than a second.
  void check_stop() const {
    if (stopped()) throw Stopped{};
  }
  /// Runs `body(i)` for i in [0, n) on the pool's threads, in any order, and waits. The first
  /// exception is rethrown. check_stop() is called before each body.
  void for_each(int n, const std::function<void(int)>& body) const;

  /// What the threads spent their time on.
  WorkLog& log() const { return *log_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  int threads_;
  std::function<bool()> stop_;
  std::unique_ptr<WorkLog> log_;
};

/// While it exists, the work of the thread that made `pool`, and its loops, are in section `name`
/// of the pool's log.
class WorkSection {
 public:
  WorkSection(const ThreadPool& pool, std::string_view name)
      : log_(pool.log()), outer_(log_.enter(name)) {}
  ~WorkSection() { log_.leave(outer_); }
  WorkSection(const WorkSection&) = delete;
  WorkSection& operator=(const WorkSection&) = delete;

 private:
  WorkLog& log_;
  std::uint32_t outer_;
};

}  // namespace lacuna
