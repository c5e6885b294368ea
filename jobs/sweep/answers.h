#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/statistics/front.h"
#include "jobs/sweep/run_result.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// Seconds before the first iteration. Cold: everything is built. Warm: what analysis finds lies in
/// the cache. Nothing: no run of the sweep shows it.
struct Preparation {
  std::optional<double> cold, warm;
};

/// When a preparation has paid against the baseline's; nothing: not within the measured times, or
/// not known.
struct BreakEvens {
  std::optional<BreakEven> cold, warm;
};

/// What the runs of a cell say.
struct CellAnswer {
  std::size_t cell = 0;                 ///< index into plan().cells
  std::size_t picture = 0;              ///< index into Answers::pictures
  std::vector<std::size_t> runs, done;  ///< indices into plan().runs: all, and those with a curve
  std::vector<BandPoint> curve;
  std::vector<ErrorAtTime> at;
  std::vector<TimeToError> to;
  std::optional<Estimate> efficiency;  ///< 1 / (squared error x seconds), at the end of each run
  std::optional<Gain> efficiency_gain;
  /// Plain means over the runs: of the squared error what is not variance, and what is.
  std::optional<Estimate> bias_squared, variance;
  /// The same from the runs' pictures together, where somebody has looked at them (jobs/report).
  std::optional<Estimate> bias_between_runs;
  Preparation preparation;
  BreakEvens pays;
};

/// Cells that estimate one picture: only their errors can be compared.
struct PictureAnswer {
  std::string text;                     ///< the settings that tell it from the other pictures
  std::vector<std::size_t> cells;       ///< indices into Answers::cells
  std::vector<double> seconds, errors;  ///< where its cells are compared
  /// Who has the lowest error when: of render time, and with preparation. `best` and `tied` are
  /// indices into plan().cells.
  std::vector<FrontPart> render, warm, cold;
};

/// A run whose times say little about its method.
struct Tainted {
  std::size_t run;
  std::string why;
};

/// Everything a sweep says so far.
struct Answers {
  CurveAxes axes;
  std::vector<RunResult> results;  ///< as plan().runs
  std::vector<CellAnswer> cells;   ///< as in the plan
  std::vector<PictureAnswer> pictures;
  std::map<State, std::size_t> states;  ///< runs in each state
  std::vector<Tainted> tainted;
  std::vector<std::string> warnings;
};

/// Reads every run and compares. Runs that are not done take no part. Throws what
/// SweepFolder::state() and read_result() throw.
Answers answer(const SweepFolder& sweep);

/// The answers as JSON: what the page and the report show (documented in
/// docs/sweeps-and-reports.md).
std::string answers_text(const SweepFolder& sweep, const Answers& answers);

}  // namespace lacuna
