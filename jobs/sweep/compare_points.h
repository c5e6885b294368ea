#pragma once

#include <span>
#include <vector>

#include "jobs/sweep/compare.h"

namespace lacuna {

/// Times at which the cells of a picture can be compared: the last time that all runs of all cells
/// reach, and a half, a quarter and a tenth of it, unless some run starts later; three digits,
/// ascending. Cells without a curve are ignored. Empty: there is no common time.
std::vector<double> natural_times(std::span<const Replicates> cells);

/// Errors at which times can be compared: the smallest error that all runs reach and keep, and
/// twice that if some run starts above it; two digits, descending.
std::vector<double> natural_errors(std::span<const Replicates> cells);

}  // namespace lacuna
