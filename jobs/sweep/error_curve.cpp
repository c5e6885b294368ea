#include "jobs/sweep/error_curve.h"

#include <algorithm>
#include <cmath>

namespace lacuna {
namespace {

/// y at x on the log-log line through two points; for equal x, the second's y.
double log_log(double x0, double y0, double x1, double y1, double x) {
  if (x0 == x1) return y1;
  return y0 * std::exp(std::log(y1 / y0) * std::log(x / x0) / std::log(x1 / x0));
}

}  // namespace

ErrorCurve::ErrorCurve(std::vector<CurvePoint> points, double held_until)
    : points_(std::move(points)), held_until_(held_until) {
  if (!points_.empty()) held_until_ = std::max(held_until_, points_.back().time);
}

std::optional<CurvePoint> ErrorCurve::at(double time) const {
  if (empty() || time < begin() || time > end()) return {};
  const auto after = std::find_if(points_.begin(), points_.end(),
                                  [&](const CurvePoint& p) { return p.time >= time; });
  if (after == points_.end())
    return CurvePoint{time, points_.back().error, points_.back().at_floor};
  if (after->time == time) return *after;
  const CurvePoint& before = *(after - 1);
  return CurvePoint{time, log_log(before.time, before.error, after->time, after->error, time),
                    after->at_floor};
}

std::optional<Crossing> ErrorCurve::reaches(double error) const {
  if (empty()) return {};
  const auto above = std::find_if(points_.rbegin(), points_.rend(),
                                  [&](const CurvePoint& p) { return p.error > error; });
  if (above == points_.rbegin()) return {};
  if (above == points_.rend()) return Crossing{begin(), true, points_.front().at_floor};
  const CurvePoint &before = *above, &after = *(above - 1);
  return Crossing{log_log(before.error, before.time, after.error, after.time, error), false,
                  after.at_floor};
}

}  // namespace lacuna
