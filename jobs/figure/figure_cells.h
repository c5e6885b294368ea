#pragma once

#include <filesystem>
#include <vector>

#include "jobs/spec/figure_spec.h"
#include "jobs/sweep/sweep_folder.h"

namespace lacuna {

/// The cells that a figure shows: those of a sweep, or of the jobs that its methods name.
struct FigureCells {
  SweepFolder sweep;
  /// The method of each cell of the plan; empty: methods are settings of the sweep's cells.
  std::vector<std::size_t> methods;
};

/// Opens what a figure's file names. `folder`: of the file, for relative paths; none: only ids in
/// the data folder are allowed. Jobs of one method that differ in label and seed alone are the runs
/// of one cell; the settings of a cell are the keys of jobs in which pictures differ, and those
/// that the file names. Throws BadJob: no such sweep, no such jobs.
FigureCells open_cells(const FigureSpec& spec, const std::optional<std::filesystem::path>& folder);

}  // namespace lacuna
