#include "tests/extremes/watchdog.h"

#include <fmt/core.h>

#include <cstdlib>

namespace lacuna::extremes {

Watchdog::Watchdog(std::chrono::seconds limit)
    : limit_(limit),
      deadline_(std::chrono::steady_clock::now() + limit),
      thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_one();
  thread_.join();
}

void Watchdog::begin(const std::string& cell) {
  const std::lock_guard lock(mutex_);
  cell_ = cell;
  deadline_ = std::chrono::steady_clock::now() + limit_;
}

void Watchdog::watch() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    if (changed_.wait_until(lock, deadline_) == std::cv_status::no_timeout) continue;
    if (over_ || std::chrono::steady_clock::now() < deadline_) continue;
    fmt::print("RED {}: hangs; it has not ended within {} s\n0 passed, 1 failed\n", cell_,
               limit_.count());
    std::fflush(stdout);
    std::_Exit(EXIT_FAILURE);
  }
}

}  // namespace lacuna::extremes
