#include "jobs/run/curve.h"

#include <fmt/format.h>

#include <cmath>

namespace lacuna {

namespace {

std::string number(std::optional<double> v) {
  return v && !std::isnan(*v) ? fmt::format("{:.17g}", *v) : "";
}

/// A flag as a byte: any other value of a bool would be undefined.
bool get_flag(ByteReader& in) {
  const auto byte = in.get<std::uint8_t>();
  if (byte > 1) throw std::runtime_error("saved curve has a flag that is neither 0 nor 1");
  return byte == 1;
}

template <class T>
void put_optional(ByteWriter& out, const std::optional<T>& value) {
  out.put(static_cast<std::uint8_t>(value.has_value()));
  if (value) out.put(*value);
}

template <class T>
std::optional<T> get_optional(ByteReader& in) {
  return get_flag(in) ? std::optional(in.get<T>()) : std::nullopt;
}

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
  if (row.iteration > 0 && !rows_.empty() && rows_.back().iteration == row.iteration) {
    rows_.pop_back();
  }
  rows_.push_back(row);
}

std::string Curve::csv() const {
  std::string text = "iteration,seconds,cpu_seconds,samples,rays,shadow_rays,";
  for (const ErrorMetricRow& metric : error_metrics) text += fmt::format("{},", metric.name);
  text += "negative,rejected,at_floor,longest_seconds\n";
  for (const CurveRow& r : rows_) {
    const auto count = [&](std::uint64_t n) { return r.iteration > 0 ? fmt::format("{}", n) : ""; };
    text += fmt::format("{},{},{},{},{},{},", count(r.iteration), number(r.seconds),
                        number(r.cpu_seconds), count(r.counters.samples), count(r.counters.rays),
                        count(r.counters.shadow_rays));
    for (const ErrorMetricRow& metric : error_metrics) text += number(r.value(metric.value)) + ',';
    text += fmt::format("{},{},{},{}\n", count(r.counters.negative), count(r.counters.rejected),
                        r.at_floor ? 1 : 0, number(r.longest_seconds));
  }
  return text;
}

void Curve::save(ByteWriter& out) const {
  out.put(static_cast<std::uint64_t>(rows_.size()));
  for (const CurveRow& r : rows_) {
    out.put(r.iteration);
    out.put(r.seconds);
    out.put(r.cpu_seconds);
    out.put(r.longest_seconds);
    out.put(r.counters);
    put_optional(out, r.errors);
    put_optional(out, r.flip);
    put_optional(out, r.est_rmse);
    out.put(static_cast<std::uint8_t>(r.at_floor));
  }
}

void Curve::load(ByteReader& in) {
  rows_.clear();
  for (auto left = in.get<std::uint64_t>(); left > 0; --left) {
    CurveRow& r = rows_.emplace_back();
    r.iteration = in.get<std::uint64_t>();
    r.seconds = in.get<double>();
    r.cpu_seconds = in.get<double>();
    r.longest_seconds = in.get<double>();
    r.counters = in.get<Counters>();
    r.errors = get_optional<Errors>(in);
    r.flip = get_optional<double>(in);
    r.est_rmse = get_optional<double>(in);
    r.at_floor = get_flag(in);
  }
}

}  // namespace lacuna
