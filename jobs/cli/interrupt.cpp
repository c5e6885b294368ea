#include "jobs/cli/interrupt.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <string_view>

#include "base/parallel/clock_seconds.h"
#include "jobs/spec/problems.h"

namespace lacuna {

namespace {

constexpr double never = 0;
std::atomic<double> requested{never};  // on the clock
static_assert(std::atomic<double>::is_always_lock_free);

extern "C" void on_signal(int signal) {
  double first = never;
  requested.compare_exchange_strong(first, clock_seconds(CLOCK_MONOTONIC));
  if (signal == SIGINT) std::signal(SIGINT, SIG_DFL);
}

}  // namespace

const std::function<bool()>& interrupt_requested() {
  static const std::function<bool()> ask = [] {
    return requested.load(std::memory_order_relaxed) != never;
  };
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  return ask;
}

double stop_grace() {
  constexpr double shortest = 2;
  const char* const named = std::getenv("LACUNA_GRACE");
  if (named == nullptr || *named == '\0') return shortest;
  const std::string_view text = named;
  double seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc() || end != text.data() + text.size() || !(seconds >= 0) ||
      !std::isfinite(seconds)) {
    throw BadJob({{"", fmt::format("LACUNA_GRACE: {}; allowed: seconds, at least 0", text)}});
  }
  return std::max(shortest, seconds);
}

double seconds_to_write(double grace) {
  const double since = clock_seconds(CLOCK_MONOTONIC) - requested.load(std::memory_order_relaxed);
  return 0.5 * grace - since;
}

}  // namespace lacuna
