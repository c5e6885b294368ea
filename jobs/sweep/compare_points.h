#pragma once

#include <span>
#include <vector>

#include "jobs/statistics/compare.h"

namespace lacuna {

/// Times at which the cells of a picture can be compared: the last that every run of every cell
/// reaches, and a half, a quarter and a tenth of it, as far as all have begun; three digits,
/// ascending. Cells without a curve do not count. Empty: they share none.
std::vector<double> natural_times(std::span<const Replicates> cells);

/// Errors that can be asked for: the smallest that every run reaches and keeps, and twice that if
/// some run began above it; two digits, descending.
std::vector<double> natural_errors(std::span<const Replicates> cells);

}  // namespace lacuna
