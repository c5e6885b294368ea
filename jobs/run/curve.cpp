#include "jobs/run/curve.h"

#include <fmt/format.h>

#include <cmath>

namespace lacuna {

namespace {

std::string number(std::optional<double> v) { return v ? fmt::format("{:.17g}", *v) : ""; }

}  // namespace

bool Curve::due(double seconds) const {
  constexpr double first = 0.1;
  if (seconds < first) return false;
  if (rows_.empty() || rows_.back().seconds < first) return true;
  // Instants are first * 2^(k/2); one lies in (last row, now].
  const auto instants = [&](double t) { return std::floor(2 * std::log2(t / first)); };
  return instants(seconds) > instants(rows_.back().seconds);
}

void Curve::add(const CurveRow& row) {
  if (!rows_.empty() && rows_.back().iteration == row.iteration) rows_.pop_back();
  rows_.push_back(row);
}

std::string Curve::csv() const {
  std::string text =
      "iteration,seconds,cpu_seconds,samples,rays,shadow_rays,mae,rmse,mse,relmse,smape,est_rmse,"
      "negative,rejected,at_floor\n";
  for (const CurveRow& r : rows_) {
    const auto error = [&](ErrorMetric m) { return number(r.value(m)); };
    text += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", r.iteration, number(r.seconds),
        number(r.cpu_seconds), r.counters.samples, r.counters.rays, r.counters.shadow_rays,
        error(ErrorMetric::mae), error(ErrorMetric::rmse), error(ErrorMetric::mse),
        error(ErrorMetric::relmse), error(ErrorMetric::smape), error(ErrorMetric::est_rmse),
        r.counters.negative, r.counters.rejected, r.at_floor ? 1 : 0);
  }
  return text;
}

}  // namespace lacuna
