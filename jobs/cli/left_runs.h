#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>

#include "jobs/cli/terminal.h"
#include "jobs/run/input_check.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// "1,4-7,9": indices of runs, from 1, which are sorted.
std::string index_ranges(const std::vector<std::size_t>& indices);
/// Indices in that form; none is above `runs`. Throws BadJob.
std::set<std::size_t> parse_indices(const std::string& text, std::size_t runs);

/// The runs that are left to do: what is not done, and what was made from other files than there
/// are now.
class LeftRuns {
 public:
  /// Only of those that are `wanted`, by their indices; empty: of all.
  LeftRuns(const SweepFolder& folder, std::set<std::size_t> wanted, Terminal& terminal);

  /// By their indices. Warns of each run whose inputs have changed and, unless only `looking`,
  /// discards its results.
  std::map<std::size_t, JobState> find(bool looking);

 private:
  bool is_stale(const SweepRun& run, const JobState& state, InputCheck& check,
                std::size_t& unrecorded);
  bool start_anew(const SweepRun& run);

  const SweepFolder& folder_;
  const std::set<std::size_t> wanted_;
  Terminal& terminal_;
  bool told_ = false;  // that some runs did not record their inputs
};

}  // namespace lacuna
