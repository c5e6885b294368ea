#pragma once

#include <optional>

#include "base/parallel/clock_seconds.h"
#include "base/parallel/thread_pool.h"

namespace lacuna {

/// The passes of an iteration, one after the other: sections of the pool's log, with their CPU
/// seconds.
class Passes {
 public:
  explicit Passes(const ThreadPool& pool) : pool_(pool) {}
  ~Passes() { end(); }
  Passes(const Passes&) = delete;
  Passes& operator=(const Passes&) = delete;

  /// Ends the present pass and begins `name`. The CPU seconds of the process until its end are
  /// added to `sum`.
  void begin(std::string_view name, double& sum) {
    end();
    sum_ = &sum;
    start_ = clock_seconds(CLOCK_PROCESS_CPUTIME_ID);
    section_.emplace(pool_, name);
  }
  void end() {
    if (sum_ != nullptr) *sum_ += clock_seconds(CLOCK_PROCESS_CPUTIME_ID) - start_;
    sum_ = nullptr;
    section_.reset();
  }

 private:
  const ThreadPool& pool_;
  double* sum_ = nullptr;
  double start_ = 0;
  std::optional<WorkSection> section_;
};

}  // namespace lacuna
