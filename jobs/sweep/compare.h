#pragma once

#include <optional>
#include <span>
#include <vector>

#include "jobs/sweep/error_curve.h"
#include "jobs/sweep/estimate.h"

namespace lacuna {

/// The curves of one cell, one per run, with independent random numbers.
using Replicates = std::span<const ErrorCurve>;

/// The ratio by which a cell is better than the baseline.
struct Gain {
  Estimate ratio;
  bool at_least = false;  ///< a lower bound without an interval: one of the times is a bound
};

/// The error of a cell at one time.
struct ErrorAtTime {
  double time = 0;
  std::size_t reached = 0;        ///< runs that have an error at this time
  std::optional<Estimate> error;  ///< if all runs have one
  bool at_floor = false;     ///< in some run most of the measured error is the reference's noise
  std::optional<Gain> gain;  ///< the baseline's error over this one
};

/// The time in which a cell reaches an error.
struct TimeToError {
  double error = 0;
  std::size_t reached = 0;       ///< runs that reached it
  std::optional<Estimate> time;  ///< if all runs reached it
  bool at_most = false;  ///< an upper bound: some runs reached it before their first instant
  std::optional<double> at_least;  ///< if not all did: the shortest time without success
  bool at_floor = false;
  std::optional<Gain> speed_up;  ///< the baseline's time over this one
};

/// A point of a mean curve.
struct BandPoint {
  double time;
  Estimate error;
  bool at_floor;
};

/// The error at `time` > 0. `baseline` may be empty: then there is no gain.
ErrorAtTime error_at_time(Replicates cell, Replicates baseline, double time);

/// The time to `error` > 0. The speed-up is a bound if all runs of the cell, but not all of the
/// baseline, reach the error, or if the cell reaches it before its first instant.
TimeToError time_to_error(Replicates cell, Replicates baseline, double error);

/// Mean and band at instants_between() the first and the last time at which all runs have an error.
/// Empty if they share none.
std::vector<BandPoint> mean_curve(Replicates cell);

/// The means of a band as a curve, which ends at the earliest end of the cell's curves.
ErrorCurve curve_of(const std::vector<BandPoint>& band, Replicates cell);

/// First and last time at which all runs have an error; none if there is no such time.
std::optional<Interval> common_times(Replicates cell);

/// `first`, the powers of sqrt(2) between, and `last`, so that the instants of different cells
/// coincide.
std::vector<double> instants_between(double first, double last);

}  // namespace lacuna
