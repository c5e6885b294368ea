#include "server/http/prometheus.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <stdexcept>

namespace lacuna {
namespace {

std::string escaped(std::string_view text, bool quotes) {
  std::string result;
  for (const char c : text) {
    if (c == '\\') {
      result += "\\\\";
    } else if (c == '\n') {
      result += "\\n";
    } else if (c == '"' && quotes) {
      result += "\\\"";
    } else {
      result += c;
    }
  }
  return result;
}

std::string number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  return fmt::format("{}", value);
}

void check_name(std::string_view name, bool colons) {
  const auto fits = [&](unsigned char c) {
    return (c < 0x80 && std::isalnum(c) != 0) || c == '_' || (colons && c == ':');
  };
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0 ||
      !std::all_of(name.begin(), name.end(), fits)) {
    throw std::invalid_argument(
        fmt::format("\"{}\" is not a valid name of a metric or label", name));
  }
}

}  // namespace

PrometheusText& PrometheusText::begin(std::string_view name, std::string_view help,
                                      std::string_view type) {
  check_name(name, true);
  name_ = name;
  if (std::find(names_.begin(), names_.end(), name_) != names_.end()) {
    throw std::invalid_argument(fmt::format("metric {} is repeated", name));
  }
  names_.push_back(name_);
  text_ += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, escaped(help, false), name, type);
  return *this;
}

PrometheusText& PrometheusText::counter(std::string_view name, std::string_view help) {
  return begin(name, help, "counter");
}

PrometheusText& PrometheusText::gauge(std::string_view name, std::string_view help) {
  return begin(name, help, "gauge");
}

PrometheusText& PrometheusText::value(double value, const Labels& labels) {
  line(name_, labels, value);
  return *this;
}

PrometheusText& PrometheusText::histogram(std::string_view name, std::string_view help,
                                          const Histogram& histogram, const Labels& labels) {
  const auto& [bounds, counts, sum] = histogram;
  if (counts.size() != bounds.size() + 1 || !std::is_sorted(bounds.begin(), bounds.end())) {
    throw std::invalid_argument(
        fmt::format("histogram {}: numbers of buckets and counts do not match", name));
  }
  begin(name, help, "histogram");
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    total += counts[i];
    Labels with_bound = labels;
    with_bound.emplace_back("le", i < bounds.size() ? number(bounds[i]) : "+Inf");
    line(name_ + "_bucket", with_bound, static_cast<double>(total));
  }
  line(name_ + "_sum", labels, sum);
  line(name_ + "_count", labels, static_cast<double>(total));
  return *this;
}

void PrometheusText::line(const std::string& name, const Labels& labels, double value) {
  text_ += name;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    check_name(labels[i].first, false);
    text_ += fmt::format("{}{}=\"{}\"", i == 0 ? "{" : ",", labels[i].first,
                         escaped(labels[i].second, true));
  }
  text_ += fmt::format("{} {}\n", labels.empty() ? "" : "}", number(value));
}

}  // namespace lacuna
