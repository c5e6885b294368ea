#include "server/http/http_metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "server/http/prometheus.h"

namespace lacuna {

void HttpMetrics::answered(int status, std::chrono::nanoseconds time) {
  ++requests.at(static_cast<std::size_t>(std::clamp(status / 100, 1, 5) - 1));
  const double s = std::chrono::duration<double>(time).count();
  const auto bucket = std::lower_bound(bounds.begin(), bounds.end(), s) - bounds.begin();
  ++seconds.at(static_cast<std::size_t>(bucket));
  microseconds += static_cast<std::uint64_t>(1e6 * s);
}

void write_metrics(PrometheusText& text, const HttpMetrics& m) {
  const auto value = [](const HttpMetrics::Count& count) { return static_cast<double>(count); };
  text.counter("lacuna_http_connections_total", "Accepted connections.").value(value(m.accepted));
  auto& requests = text.counter("lacuna_http_requests_total", "Responses, by class of status.");
  for (std::size_t i = 0; i < m.requests.size(); ++i) {
    requests.value(value(m.requests[i]), {{"status", fmt::format("{}xx", i + 1)}});
  }
  text.histogram("lacuna_http_request_seconds",
                 "Time from the arrival of a request's head to its response.",
                 {{m.bounds.begin(), m.bounds.end()},
                  {m.seconds.begin(), m.seconds.end()},
                  1e-6 * value(m.microseconds)});
  text.counter("lacuna_http_sent_bytes_total", "Bytes of responses, without heads.")
      .value(value(m.bytes_out));
  text.gauge("lacuna_http_connections", "Open connections, each with a thread.")
      .value(value(m.connections));
  text.gauge("lacuna_http_in_progress", "Requests in progress.").value(value(m.in_progress));
  text.gauge("lacuna_http_streams", "Open event streams.").value(value(m.streams));
}

}  // namespace lacuna
