#pragma once

#include <optional>

#include "jobs/run/curve.h"
#include "jobs/spec/job_spec.h"

namespace lacuna {

/// What a job has used of its budget so far.
struct Spent {
  std::uint64_t iterations = 0;
  double seconds = 0, cpu_seconds = 0;
  /// For a picture merged from shards: the longest of their clocks, while `seconds` is the sum.
  /// Time rendered after merging counts in both.
  double longest_seconds = 0;
};

/// Whether a limit of time or of iterations is reached.
bool exhausted(const Budget& budget, const Spent& spent);

/// Whether one more iteration of average length would end clearly after a time limit; it is not
/// started then, because its result would be discarded. False before the first iteration.
bool would_overrun(const Budget& budget, const Spent& spent);

/// Whether a time limit has passed. An iteration in progress is abandoned then, except the first.
bool out_of_time(const Budget& budget, const Spent& spent);

/// Whether the latest row of the curve meets the error target.
bool target_met(const Budget& budget, const Curve& curve);

/// The spent share of the limit that will be reached first, in [0, 1].
double share(const Budget& budget, const Spent& spent);

}  // namespace lacuna
