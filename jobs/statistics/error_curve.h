#pragma once

#include <optional>
#include <vector>

namespace lacuna {

/// One instant of a curve; both values positive.
struct CurvePoint {
  double time, error;
  bool at_floor = false;  ///< the reference's own noise is more than half of what was measured
};

/// When an error was reached for good.
struct Crossing {
  double time;
  bool at_most = false;  ///< the curve begins below it: it was reached at `time` or before
  bool at_floor = false;
};

/// The error of one run against time. Between two instants it is interpolated in log-log, where
/// errors of Monte Carlo estimates are lines.
class ErrorCurve {
 public:
  ErrorCurve() = default;
  /// `points` in the order of their times, which differ. `held_until` >= the last time: until then
  /// no later picture would have been finished, so that the last error is what one has.
  ErrorCurve(std::vector<CurvePoint> points, double held_until);

  const std::vector<CurvePoint>& points() const { return points_; }
  bool empty() const { return points_.empty(); }
  /// First and last time at which there is an error; not of an empty curve.
  double begin() const { return points_.front().time; }
  double end() const { return held_until_; }

  /// The point at `time`; nothing outside [begin(), end()].
  std::optional<CurvePoint> at(double time) const;
  /// From when on the error stays at or below `error`; nothing if it is above at the end. An early
  /// picture, black but for what a few paths found, may lie below and rise with the first bright
  /// path: that is luck, not an error reached.
  std::optional<Crossing> reaches(double error) const;

 private:
  std::vector<CurvePoint> points_;
  double held_until_ = 0;
};

}  // namespace lacuna
