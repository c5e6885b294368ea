#pragma once

#include <optional>

#include "jobs/run/curve.h"
#include "jobs/spec/job_spec.h"

namespace lacuna {

/// What a job has used and reached so far.
struct Spent {
  std::uint64_t iterations = 0;
  double seconds = 0, cpu_seconds = 0;
};

/// The limit of time or iterations is reached.
bool exhausted(const Budget& budget, const Spent& spent);

/// One more iteration of average length would end clearly beyond a limit of time: it is not begun,
/// for its result would not count. Never before the first.
bool would_overrun(const Budget& budget, const Spent& spent);

/// A limit of time has passed: an iteration under way is given up, unless it is the first.
bool out_of_time(const Budget& budget, const Spent& spent);

/// The error target is met by the latest row.
bool target_met(const Budget& budget, const Curve& curve);

/// Share of the limit that will be reached first, in [0, 1].
double share(const Budget& budget, const Spent& spent);

}  // namespace lacuna
