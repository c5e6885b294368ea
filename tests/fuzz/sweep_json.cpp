#include <optional>

#include "jobs/spec/described_json.h"
#include "jobs/spec/job_json.h"
#include "jobs/sweep/expand.h"
#include "tests/fuzz/expect.h"
#include "tests/fuzz/target.h"

// A sweep file: refused with its problems, or one that is written and read back without a change
// and whose every run is a job.

namespace lacuna::fuzz {
namespace {

template <class F>
auto unless_refused(const F& f) -> std::optional<decltype(f())> {
  try {
    return f();
  } catch (const BadJob& bad) {
    expect(!bad.problems().empty(), "a sweep that is refused has a problem");
    return std::nullopt;
  }
}

/// Few enough to expand in no time.
bool is_small(const SweepSpec& sweep) {
  std::size_t cells = 1;
  const auto count = [&cells](std::size_t n) { cells = std::min<std::size_t>(cells * n, 1000); };
  for (const auto& axis : sweep.axes) count(axis.second.size());
  for (const auto& zip : sweep.zip) count(zip.empty() ? 1 : zip.begin()->second.size());
  return cells < 100;
}

}  // namespace
}  // namespace lacuna::fuzz

LACUNA_FUZZ_TARGET(sweep_json) {
  using namespace lacuna;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto sweep = fuzz::unless_refused([&] { return parse_sweep(text); });
  if (!sweep) return 0;
  fuzz::expect(parse_sweep(write_document(*sweep)) == *sweep, "it is written and read back equal");
  if (!fuzz::is_small(*sweep)) return 0;
  const auto plan = fuzz::unless_refused([&] { return expand(*sweep); });
  if (!plan) return 0;
  fuzz::expect(plan->runs.size() == plan->cells.size() * static_cast<std::size_t>(sweep->seeds),
               "every cell has its runs");
  for (const SweepCell& cell : plan->cells) {
    fuzz::expect(parse_job(write_job(cell.job)) == cell.job, "a cell's job is a job");
    fuzz::expect(!cell.baseline || *cell.baseline < plan->cells.size(), "a baseline is a cell");
  }
  return 0;
}
