#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacuna {

/// Writes metrics in Prometheus's text format, version 0.0.4:
///
///     text.gauge("lacuna_jobs", "Jobs, by state.").value(3, {{"state", "queued"}});
class PrometheusText {
 public:
  using Labels = std::vector<std::pair<std::string, std::string>>;
  static constexpr std::string_view media_type = "text/plain; version=0.0.4; charset=utf-8";

  /// Begins a metric; its values follow. Throws std::invalid_argument for an invalid or repeated
  /// name.
  PrometheusText& counter(std::string_view name, std::string_view help);
  PrometheusText& gauge(std::string_view name, std::string_view help);
  /// Adds a value of the latest metric. Throws std::invalid_argument for an invalid name of a
  /// label.
  PrometheusText& value(double value, const Labels& labels = {});

  /// The values of a histogram.
  struct Histogram {
    std::vector<double> bounds;         ///< upper bounds of the buckets, ascending
    std::vector<std::uint64_t> counts;  ///< of each bucket, not cumulative, then above all bounds
    double sum = 0;                     ///< of all values
  };
  /// A metric with one histogram. Throws std::invalid_argument if the numbers of bounds and counts
  /// do not match.
  PrometheusText& histogram(std::string_view name, std::string_view help,
                            const Histogram& histogram, const Labels& labels = {});

  const std::string& text() const { return text_; }

 private:
  PrometheusText& begin(std::string_view name, std::string_view help, std::string_view type);
  void line(const std::string& name, const Labels& labels, double value);

  std::string text_, name_;
  std::vector<std::string> names_;
};

}  // namespace lacuna
