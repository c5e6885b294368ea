#include "jobs/sweep/taint.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacuna {
namespace {

constexpr double most_taken = 0.05;      // of all processors' time
constexpr double least_frequency = 0.9;  // of the sweep's highest

void add(std::string& why, const std::string& more) { why += (why.empty() ? "" : ", ") + more; }

}  // namespace

std::vector<Tainted> tainted_runs(std::span<const RunResult> results) {
  double highest = 0;
  for (const RunResult& r : results) highest = std::max(highest, r.mhz.value_or(0));
  std::vector<Tainted> tainted;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const RunResult& r = results[i];
    std::string why;
    if (r.others.value_or(0) > most_taken) {
      add(why, fmt::format("other processes took {:.0f} %", 100 * *r.others));
    }
    if (r.stolen.value_or(0) > most_taken) {
      add(why, fmt::format("the host took {:.0f} %", 100 * *r.stolen));
    }
    if (r.mhz && *r.mhz < least_frequency * highest) {
      add(why, fmt::format("{:.0f} MHz instead of {:.0f}", *r.mhz, highest));
    }
    if (!why.empty()) tainted.push_back({i, why});
  }
  return tainted;
}

}  // namespace lacuna
