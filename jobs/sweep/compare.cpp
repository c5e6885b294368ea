#include "jobs/sweep/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacuna {
namespace {

struct ErrorsThere {
  std::vector<double> values;
  bool at_floor = false;
};

/// The errors of those runs that have one at `time`.
ErrorsThere errors_at(Replicates cell, double time) {
  ErrorsThere e;
  for (const ErrorCurve& curve : cell) {
    const auto point = curve.at(time);
    if (!point) continue;
    e.values.push_back(point->error);
    e.at_floor |= point->at_floor;
  }
  return e;
}

struct Times {
  std::vector<double> values;
  bool at_most = false, at_floor = false;
  double without_success = std::numeric_limits<double>::infinity();
};

Times times_to(Replicates cell, double error) {
  Times t;
  for (const ErrorCurve& curve : cell) {
    if (const auto crossing = curve.reaches(error)) {
      t.values.push_back(crossing->time);
      t.at_most |= crossing->at_most;
      t.at_floor |= crossing->at_floor;
    } else if (!curve.empty()) {
      t.without_success = std::min(t.without_success, curve.end());
    }
  }
  return t;
}

}  // namespace

ErrorAtTime error_at_time(Replicates cell, Replicates baseline, double time) {
  const ErrorsThere own = errors_at(cell, time), base = errors_at(baseline, time);
  ErrorAtTime answer{time, own.values.size(), {}, own.at_floor, {}};
  if (own.values.empty() || own.values.size() < cell.size()) return answer;
  answer.error = geometric_mean(own.values);
  if (baseline.empty() || base.values.size() < baseline.size()) return answer;
  answer.gain = Gain{ratio_of_means(base.values, own.values)};
  answer.at_floor |= base.at_floor;
  return answer;
}

TimeToError time_to_error(Replicates cell, Replicates baseline, double error) {
  const Times own = times_to(cell, error), base = times_to(baseline, error);
  TimeToError answer{error, own.values.size(), {}, own.at_most, {}, own.at_floor, {}};
  if (std::isfinite(own.without_success)) answer.at_least = own.without_success;
  if (own.values.empty() || own.values.size() < cell.size()) return answer;
  answer.time = geometric_mean(own.values);
  if (baseline.empty()) return answer;
  if (base.at_most) return answer;  // its time is unknown
  if (base.values.size() == baseline.size()) {
    answer.speed_up = Gain{ratio_of_means(base.values, own.values), own.at_most};
    if (own.at_most) answer.speed_up->ratio.interval.reset();
    answer.at_floor |= base.at_floor;
  } else if (std::isfinite(base.without_success)) {
    answer.speed_up =
        Gain{{base.without_success / answer.time->value, {}, own.values.size()}, true};
  }
  return answer;
}

std::optional<Interval> common_times(Replicates cell) {
  Interval common{0, std::numeric_limits<double>::infinity()};
  for (const ErrorCurve& curve : cell) {
    if (curve.empty()) return {};
    common = {std::max(common.low, curve.begin()), std::min(common.high, curve.end())};
  }
  return !cell.empty() && common.low <= common.high ? std::optional(common) : std::nullopt;
}

std::vector<double> instants_between(double first, double last) {
  std::vector<double> instants{first};
  for (auto k = static_cast<int>(std::ceil(2 * std::log2(first)));; ++k) {
    const double t = std::exp2(k / 2.0);
    if (t >= last) break;
    if (t > first) instants.push_back(t);
  }
  if (last > first) instants.push_back(last);
  return instants;
}

std::vector<BandPoint> mean_curve(Replicates cell) {
  std::vector<BandPoint> band;
  const auto common = common_times(cell);
  if (!common) return band;
  for (const double t : instants_between(common->low, common->high)) {
    const ErrorAtTime at = error_at_time(cell, {}, t);
    if (at.error) band.push_back({t, *at.error, at.at_floor});
  }
  return band;
}

ErrorCurve curve_of(const std::vector<BandPoint>& band, Replicates cell) {
  std::vector<CurvePoint> points;
  points.reserve(band.size());
  for (const BandPoint& p : band) points.push_back({p.time, p.error.value, p.at_floor});
  const auto common = common_times(cell);
  return {std::move(points), common ? common->high : 0};
}

}  // namespace lacuna
