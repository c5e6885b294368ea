#pragma once

#include <chrono>
#include <cstddef>

namespace lacuna {

/// A deadline that is extended while a transfer keeps a minimum rate: at least `bytes` in each
/// window of `time`, regardless of earlier windows. Without `bytes` it is fixed.
class PacedDeadline {
 public:
  using Clock = std::chrono::steady_clock;

  explicit PacedDeadline(std::chrono::milliseconds time, std::size_t bytes = SIZE_MAX)
      : time_(time), bytes_(bytes), end_(Clock::now() + time) {}

  void restart() {
    end_ = Clock::now() + time_;
    counted_ = 0;
  }
  void count(std::size_t bytes) { counted_ += bytes; }
  /// Begins the next window if this one is at its end and brought enough.
  bool over() {
    if (Clock::now() < end_) return false;
    if (counted_ < bytes_) return true;
    restart();
    return false;
  }
  Clock::time_point end() const { return end_; }

 private:
  std::chrono::milliseconds time_;
  std::size_t bytes_;
  std::size_t counted_ = 0;
  Clock::time_point end_;
};

}  // namespace lacuna
