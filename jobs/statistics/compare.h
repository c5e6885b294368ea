#pragma once

#include <optional>
#include <span>
#include <vector>

#include "jobs/statistics/error_curve.h"
#include "jobs/statistics/estimate.h"

namespace lacuna {

/// The curves of one cell: a run each, with random numbers of its own.
using Replicates = std::span<const ErrorCurve>;

/// How many times better than the baseline.
struct Gain {
  Estimate ratio;
  bool at_least = false;  ///< a bound, without an interval: one of the two times is one
};

/// The error of a cell at one time.
struct ErrorAtTime {
  double time = 0;
  std::size_t reached = 0;        ///< runs that have an error at this time
  std::optional<Estimate> error;  ///< if all have
  bool at_floor = false;          ///< of any: the reference is too noisy to say more
  std::optional<Gain> gain;       ///< the baseline's error over this one
};

/// The time that a cell takes to an error.
struct TimeToError {
  double error = 0;
  std::size_t reached = 0;         ///< runs that reached it
  std::optional<Estimate> time;    ///< if all did
  bool at_most = false;            ///< some did before their first instant
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

/// The error at `time`, > 0. An empty `baseline`: there is none.
ErrorAtTime error_at_time(Replicates cell, Replicates baseline, double time);

/// The time to `error`, > 0. If the baseline did not reach it in every run and the cell did, or the
/// cell did before its first instant, the speed-up is a bound.
TimeToError time_to_error(Replicates cell, Replicates baseline, double error);

/// Mean and band at instants_between() the first and the last time at which all runs have an error.
/// Empty if they share none.
std::vector<BandPoint> mean_curve(Replicates cell);

/// The means of a band as a curve; it is held as long as all of the `cell` are.
ErrorCurve curve_of(const std::vector<BandPoint>& band, Replicates cell);

/// First and last time at which all runs have an error; nothing if there is none.
std::optional<Interval> common_times(Replicates cell);

/// `first`, the powers of sqrt(2) between, and `last`: those of different cells agree.
std::vector<double> instants_between(double first, double last);

}  // namespace lacuna
