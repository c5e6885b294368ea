#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "jobs/sweep/front.h"
#include "jobs/sweep/run_result.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// Seconds before the first iteration. Cold: all artefacts are built. Warm: they are loaded from
/// the cache. None: not measured by any run of the sweep.
struct Preparation {
  std::optional<double> cold, warm;
};

/// The time at which a cell's preparation has paid off against the baseline; none: not within the
/// measured times, or unknown.
struct BreakEvens {
  std::optional<BreakEven> cold, warm;
};

/// The results of a cell's runs.
struct CellAnswer {
  std::size_t cell = 0;                 ///< index into plan().cells
  std::size_t picture = 0;              ///< index into Answers::pictures
  std::vector<std::size_t> runs, done;  ///< indices into plan().runs: all, and those with a curve
  std::vector<BandPoint> curve;
  std::vector<ErrorAtTime> at;
  std::vector<TimeToError> to;
  std::optional<Estimate> efficiency;  ///< 1 / (squared error x seconds), at the end of each run
  std::optional<Gain> efficiency_gain;
  /// Means over the runs of the two parts of the squared error: bias squared, and variance.
  std::optional<Estimate> bias_squared, variance;
  /// The squared bias from the runs' pictures together, if they were read (jobs/report).
  std::optional<Estimate> bias_between_runs;
  Preparation preparation;
  BreakEvens pays;
};

/// The cells that estimate one picture, whose errors can be compared.
struct PictureAnswer {
  std::string text;                     ///< the settings that differ from the other pictures
  std::vector<std::size_t> cells;       ///< indices into Answers::cells
  std::vector<double> seconds, errors;  ///< at which its cells are compared
  /// The cells of lowest error over time: by render time, and with warm and cold preparation.
  /// `best` and `tied` are indices into plan().cells.
  std::vector<FrontPart> render, warm, cold;
};

/// A run whose times were disturbed by other load on the machine.
struct Tainted {
  std::size_t run;
  std::string why;
};

/// All results of a sweep so far.
struct Answers {
  CurveAxes axes;
  std::vector<RunResult> results;  ///< as plan().runs
  std::vector<CellAnswer> cells;   ///< as in the plan
  std::vector<PictureAnswer> pictures;
  std::map<State, std::size_t> states;  ///< runs in each state
  std::vector<Tainted> tainted;
  std::map<std::size_t, std::string> stale;  ///< excluded runs (stale_runs())
  std::vector<std::string> warnings;
};

/// Reads and compares all runs that are done. Throws the exceptions of SweepFolder::state() and
/// read_result().
Answers answer(const SweepFolder& sweep);
/// The same at other times and errors than the sweep's own, by another metric or clock.
Answers answer(const SweepFolder& sweep, const CompareAt& at);

/// The answers as JSON, for the page and the report (docs/sweeps-and-reports.md).
std::string answers_text(const SweepFolder& sweep, const Answers& answers);

}  // namespace lacuna
