#include "jobs/cli/interrupt.h"

#include <csignal>

#include <atomic>

namespace lacuna {

namespace {

std::atomic<bool> requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void on_signal(int signal) {
  requested = true;
  if (signal == SIGINT) std::signal(SIGINT, SIG_DFL);
}

}  // namespace

const std::function<bool()>& interrupt_requested() {
  static const std::function<bool()> ask = [] { return requested.load(std::memory_order_relaxed); };
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  return ask;
}

}  // namespace lacuna
