#pragma once

#include <span>
#include <vector>

#include "jobs/sweep/compare.h"

namespace lacuna {

/// Times at which the cells of a picture can be compared: the last time that all runs of all cells
/// reach, and 1/2, 1/4 and 1/10 of it, unless some run starts later; three digits, ascending.
/// Ignores cells without a curve. Empty: no common time.
std::vector<double> natural_times(std::span<const Replicates> cells);

/// Errors at which times can be compared: the smallest error that all runs reach and keep, and
/// twice that if some run starts above it; two digits, descending.
std::vector<double> natural_errors(std::span<const Replicates> cells);

}  // namespace lacuna
