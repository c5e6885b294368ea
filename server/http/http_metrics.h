#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace lacuna {

class PrometheusText;

/// Metrics of the HTTP layer since its start. Written and read by any thread.
struct HttpMetrics {
  using Count = std::atomic<std::uint64_t>;

  /// Upper bounds of the buckets of `seconds`, in seconds; one more bucket has none.
  static constexpr std::array<double, 13> bounds{0.001, 0.0025, 0.005, 0.01, 0.025, 0.05, 0.1,
                                                 0.25,  0.5,    1,     2.5,  5,     10};

  Count accepted{0};     ///< connections
  Count connections{0};  ///< gauge: open ones, each with a thread
  Count in_progress{0};  ///< gauge: requests whose head has arrived and whose response is not sent
  Count streams{0};      ///< gauge: open event streams
  Count bytes_out{0};    ///< of responses, without heads
  std::array<Count, 5> requests{};                 ///< answered, by the first digit of the status
  std::array<Count, bounds.size() + 1> seconds{};  ///< from a request's head to the response's
  Count microseconds{0};                           ///< their sum

  void answered(int status, std::chrono::nanoseconds time);
};

/// Increments a gauge during its life.
class Counted {
 public:
  explicit Counted(HttpMetrics::Count& count) : count_(count) { ++count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --count_; }

 private:
  HttpMetrics::Count& count_;
};

/// Writes all metrics, named lacuna_http_...
void write_metrics(PrometheusText& text, const HttpMetrics& metrics);

}  // namespace lacuna
