#pragma once

#include <cstddef>
#include <map>
#include <set>
#include <string>

#include "jobs/cli/terminal.h"
#include "jobs/run/input_check.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// "1,4-7,9": the text of sorted indices of runs, from 1.
std::string index_ranges(const std::vector<std::size_t>& indices);
/// Parses that form; indices are at most `runs`. Throws BadJob.
std::set<std::size_t> parse_indices(const std::string& text, std::size_t runs);

/// The runs that remain to be rendered: unfinished ones, and those whose input files have changed.
class LeftRuns {
 public:
  /// `wanted`: indices of the runs to consider; empty: all.
  LeftRuns(const SweepFolder& folder, std::set<std::size_t> wanted, Terminal& terminal);

  /// The remaining runs by index. Warns of each run whose inputs have changed and, unless
  /// `looking`, discards its results.
  std::map<std::size_t, JobState> find(bool looking);

 private:
  bool is_stale(const SweepRun& run, const JobState& state, InputCheck& check,
                std::size_t& unrecorded);
  bool start_anew(const SweepRun& run);

  const SweepFolder& folder_;
  const std::set<std::size_t> wanted_;
  Terminal& terminal_;
  bool told_ = false;  // whether the warning of unrecorded inputs was given
};

}  // namespace lacuna
