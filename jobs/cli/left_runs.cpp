#include "jobs/cli/left_runs.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <sstream>
#include <utility>
#include <vector>

#include "jobs/cli/render_job.h"
#include "jobs/run/run_job.h"
#include "jobs/spec/problems.h"

namespace lacuna {

std::string index_ranges(const std::vector<std::size_t>& indices) {
  std::string text;
  for (std::size_t i = 0; i < indices.size();) {
    std::size_t end = i;
    while (end + 1 < indices.size() && indices[end + 1] == indices[end] + 1) ++end;
    text += fmt::format("{}{}", text.empty() ? "" : ",", indices[i]);
    if (end > i) text += fmt::format("-{}", indices[end]);
    i = end + 1;
  }
  return text;
}

std::set<std::size_t> parse_indices(const std::string& text, std::size_t runs) {
  const auto refuse = [&](const std::string& what) {
    throw BadJob({{"", fmt::format("--index {}: {}", text, what)}});
  };
  std::set<std::size_t> indices;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    std::size_t first = 0, last = 0;
    const char* end = part.data() + part.size();
    auto read = std::from_chars(part.data(), end, first);
    last = first;
    if (read.ec == std::errc() && read.ptr != end && *read.ptr == '-') {
      read = std::from_chars(read.ptr + 1, end, last);
    }
    if (read.ec != std::errc() || read.ptr != end || first < 1 || last < first) {
      refuse("allowed: indices and ranges of them, such as 1,4-7");
    }
    if (last > runs) refuse(fmt::format("the sweep has runs 1 to {}", runs));
    for (std::size_t i = first; i <= last; ++i) indices.insert(i);
  }
  return indices;
}

LeftRuns::LeftRuns(const SweepFolder& folder, std::set<std::size_t> wanted, Terminal& terminal)
    : folder_(folder), wanted_(std::move(wanted)), terminal_(terminal) {}

std::map<std::size_t, JobState> LeftRuns::find(bool looking) {
  std::map<std::size_t, JobState> left;
  std::size_t unrecorded = 0;
  InputCheck check(DataRoot::from_environment(), ScenesRoots::from_environment());
  for (std::size_t i = 1; i <= folder_.plan().runs.size(); ++i) {
    if (!wanted_.empty() && !wanted_.contains(i)) continue;
    const SweepRun& run = folder_.plan().runs[i - 1];
    JobState state = folder_.state(run);
    if (is_stale(run, state, check, unrecorded) && (looking || start_anew(run))) {
      state.state = State::queued;
    }
    if (state.state != State::done) left.emplace(i, std::move(state));
  }
  if (unrecorded > 0 && !std::exchange(told_, true)) {
    terminal_.warning(fmt::format("{} runs: {}", unrecorded, inputs_not_recorded));
  }
  return left;
}

bool LeftRuns::is_stale(const SweepRun& run, const JobState& state, InputCheck& check,
                        std::size_t& unrecorded) {
  if (state.created.empty()) return false;  // not created yet
  const auto changes = check.changes(folder_.folder(run));
  if (!changes) {
    ++unrecorded;
    return false;
  }
  if (changes->empty()) return false;
  terminal_.warning(fmt::format("the input files of {} have changed ({}): it is rendered again",
                                run.name, fmt::join(*changes, "; ")));
  return true;
}

/// False if another process has its lock.
bool LeftRuns::start_anew(const SweepRun& run) {
  try {
    start_again(folder_.folder(run));
    return true;
  } catch (const FolderBusy& e) {
    terminal_.warning(e.what());
    return false;
  }
}

}  // namespace lacuna
