#pragma once

#include <algorithm>

#include "base/parallel/clock_seconds.h"

namespace lacuna {

/// Measures render time by two clocks: wall seconds, and CPU seconds of the process divided by its
/// threads, which do not include other load on the machine.
class RenderClock {
 public:
  explicit RenderClock(int threads) : threads_(threads) {}

  void start() {
    wall_start_ = clock_seconds(CLOCK_MONOTONIC);
    cpu_start_ = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    running_ = true;
  }
  void stop() {
    wall_ = seconds();
    cpu_ = cpu_seconds();
    running_ = false;
  }
  double seconds() const {
    return wall_ + (running_ ? clock_seconds(CLOCK_MONOTONIC) - wall_start_ : 0);
  }
  double cpu_seconds() const {
    return cpu_ +
           (running_ ? (clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - cpu_start_) / threads_ : 0);
  }
  /// Continues from the times of a checkpoint, seconds.
  void set(double wall, double cpu) {
    wall_ = wall;
    cpu_ = cpu;
  }

 private:
  int threads_;
  bool running_ = false;
  double wall_ = 0, cpu_ = 0;
  double wall_start_ = 0, cpu_start_ = 0;
};

/// Limits how often a costly action is repeated: at intervals of at least `interval` seconds, and
/// such that the action takes at most `share` of all time.
class Pace {
 public:
  Pace(double interval, double share) : interval_(interval), share_(share) { done(0); }

  bool due() const { return clock_seconds(CLOCK_MONOTONIC) >= next_; }
  /// Reports that the action was done and took `cost` seconds.
  void done(double cost) {
    next_ = clock_seconds(CLOCK_MONOTONIC) + std::max(interval_, cost / share_);
  }

 private:
  double interval_, share_;
  double next_ = 0;
};

/// Adds the wall seconds of a scope to `sum`.
class ScopedSeconds {
 public:
  explicit ScopedSeconds(double& sum) : sum_(sum), start_(clock_seconds(CLOCK_MONOTONIC)) {}
  ~ScopedSeconds() { sum_ += clock_seconds(CLOCK_MONOTONIC) - start_; }
  ScopedSeconds(const ScopedSeconds&) = delete;
  ScopedSeconds& operator=(const ScopedSeconds&) = delete;

 private:
  double& sum_;
  double start_;
};

}  // namespace lacuna
