#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "server/http/http_metrics.h"
#include "server/http/prometheus.h"

namespace lacuna {
namespace {

TEST(Prometheus, WritesValuesWithEscapedLabels) {
  PrometheusText text;
  text.counter("jobs_total", "Jobs,\nby \\ \"state\".")
      .value(3, {{"state", "queued"}, {"label", "a\"b\\c\nd"}})
      .value(12345678901234.0);
  text.gauge("share", "")
      .value(0.1)
      .value(std::nan(""))
      .value(-std::numeric_limits<double>::infinity());
  EXPECT_EQ(text.text(),
            "# HELP jobs_total Jobs,\\nby \\\\ \"state\".\n# TYPE jobs_total counter\n"
            "jobs_total{state=\"queued\",label=\"a\\\"b\\\\c\\nd\"} 3\n"
            "jobs_total 12345678901234\n"
            "# HELP share \n# TYPE share gauge\nshare 0.1\nshare NaN\nshare -Inf\n");
}

TEST(Prometheus, SumsHistogramsUp) {
  PrometheusText text;
  text.histogram("seconds", "Time.", {{0.5, 1}, {2, 0, 3}, 7.25}, {{"kind", "x"}});
  EXPECT_EQ(text.text(),
            "# HELP seconds Time.\n# TYPE seconds histogram\n"
            "seconds_bucket{kind=\"x\",le=\"0.5\"} 2\nseconds_bucket{kind=\"x\",le=\"1\"} 2\n"
            "seconds_bucket{kind=\"x\",le=\"+Inf\"} 5\nseconds_sum{kind=\"x\"} 7.25\n"
            "seconds_count{kind=\"x\"} 5\n");
}

TEST(Prometheus, RefusesWhatItsReadersWould) {
  PrometheusText text;
  text.gauge("a", "");
  EXPECT_THROW(text.gauge("a", ""), std::invalid_argument) << "twice";
  EXPECT_THROW(text.gauge("9a", ""), std::invalid_argument);
  EXPECT_THROW(text.gauge("a b", ""), std::invalid_argument);
  EXPECT_THROW(text.gauge("", ""), std::invalid_argument);
  EXPECT_THROW(text.value(1, {{"a:b", ""}}), std::invalid_argument);
  EXPECT_THROW(text.histogram("h", "", {{1}, {1}, 0}), std::invalid_argument);
  EXPECT_THROW(text.histogram("h", "", {{2, 1}, {1, 1, 1}, 0}), std::invalid_argument);
}

TEST(HttpMetrics, CountsByClassAndBucket) {
  HttpMetrics metrics;
  metrics.answered(200, std::chrono::microseconds(1000));
  metrics.answered(404, std::chrono::microseconds(1001));
  metrics.answered(503, std::chrono::seconds(11));
  EXPECT_EQ(metrics.requests[1], 1U);
  EXPECT_EQ(metrics.requests[3], 1U);
  EXPECT_EQ(metrics.requests[4], 1U);
  EXPECT_EQ(metrics.seconds.front(), 1U) << "bounds belong to their bucket";
  EXPECT_EQ(metrics.seconds[1], 1U);
  EXPECT_EQ(metrics.seconds.back(), 1U);
  PrometheusText text;
  write_metrics(text, metrics);
  EXPECT_NE(text.text().find("lacuna_http_requests_total{status=\"4xx\"} 1\n"), std::string::npos);
  EXPECT_NE(text.text().find("lacuna_http_request_seconds_count 3\n"), std::string::npos);
}

}  // namespace
}  // namespace lacuna
