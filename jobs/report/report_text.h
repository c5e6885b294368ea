#pragma once

#include <string>

#include "jobs/sweep/answers.h"

namespace lacuna {

/// A summary of the answers for a terminal: for each picture the best cell over time, and for each
/// cell its error at the last common time and its time to the smallest common error, with intervals
/// and gains.
std::string report_text(const SweepFolder& sweep, const Answers& answers);

}  // namespace lacuna
