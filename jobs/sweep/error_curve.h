#pragma once

#include <optional>
#include <vector>

namespace lacuna {

/// One instant of a curve; both values positive.
struct CurvePoint {
  double time, error;
  bool at_floor = false;  ///< the reference's own noise is more than half of what was measured
};

/// The time after which the error of a run stays at or below a value.
struct Crossing {
  double time;
  bool at_most = false;  ///< the curve begins below the value, so `time` is an upper bound
  bool at_floor = false;
};

/// The error of one run against time. It is interpolated log-log between instants, because errors
/// of Monte Carlo estimates are power laws of time.
class ErrorCurve {
 public:
  ErrorCurve() = default;
  /// `points` in order of strictly increasing times. `held_until` >= the last time: the last error
  /// holds until then, because no later iteration would have finished before.
  ErrorCurve(std::vector<CurvePoint> points, double held_until);

  const std::vector<CurvePoint>& points() const { return points_; }
  bool empty() const { return points_.empty(); }
  /// The first and last time at which the error is known. The curve must not be empty.
  double begin() const { return points_.front().time; }
  double end() const { return held_until_; }

  /// The point at `time`; nothing outside [begin(), end()].
  std::optional<CurvePoint> at(double time) const;
  /// The time after which the error stays at or below `error`; none if it is above at the end.
  /// Earlier crossings do not count: an early picture that is mostly black may have a small error
  /// by chance, which rises with the first bright path.
  std::optional<Crossing> reaches(double error) const;

 private:
  std::vector<CurvePoint> points_;
  double held_until_ = 0;
};

}  // namespace lacuna
