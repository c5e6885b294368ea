#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "jobs/spec/job_spec.h"
#include "jobs/spec/problems.h"
#include "jobs/spec/sweep_spec.h"

namespace lacuna {

/// Size limit of a sweep file, in bytes.
inline constexpr std::size_t max_sweep_bytes = 4 << 20;
/// Most runs of one sweep.
inline constexpr std::size_t max_sweep_runs = 20'000;

/// One combination of the swept settings.
struct SweepCell {
  JsonTable<JsonValue> settings;        ///< by pointer
  JobSpec job;                          ///< with its first seed
  std::optional<std::size_t> baseline;  ///< the cell to compare it with, if any
};

/// One job of a sweep.
struct SweepRun {
  std::size_t cell;
  int replicate;     ///< 0 .. seeds - 1
  std::string name;  ///< "0007-2": cell and replicate, from 1; safe as a file name
};

/// All runs of a sweep, in their order.
struct SweepPlan {
  std::vector<SweepCell> cells;
  std::vector<SweepRun> runs;

  /// The job of a run: the cell's, with its seed and a label.
  JobSpec job_of(const SweepRun& run) const;
};

/// Parses and validates a sweep file; as parse_job(). Throws BadJob.
SweepSpec parse_sweep(std::string_view json);

/// Checks a job beyond its own text, for example for missing files; pointers are into the job.
using JobCheck = std::function<std::vector<Problem>(const JobSpec&)>;

/// Expands a sweep into its cells: axes in the order of their pointers, then the zipped axes in
/// file order; the last varies fastest. Deterministic. Throws BadJob for a pointer to no setting, a
/// setting swept twice, lists of different length, values in `exclude` or `baseline` that no axis
/// has, no cells or too many runs, and every problem of a cell's job (including those of `check`),
/// at the position in the sweep file that it comes from.
SweepPlan expand(const SweepSpec& sweep, const JobCheck& check = {});

/// The settings of some cells of a plan.
struct VaryingSettings {
  JsonTable<JsonValue> shared;    ///< equal in all of these cells, but not in the whole plan
  std::vector<std::string> vary;  ///< pointers to settings that differ among these cells
};
VaryingSettings settings_that_vary(const SweepPlan& plan, const std::vector<std::size_t>& cells);

/// "integrator path (reuse 64), resolution [64,64]": the settings of a cell, by the last part of
/// each pointer, extended where two have the same end.
std::string cell_text(const JsonTable<JsonValue>& settings);

}  // namespace lacuna
