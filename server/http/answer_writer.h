#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "server/http/http_metrics.h"
#include "server/http/message.h"

namespace httplib {
struct Request;
struct Response;
class DataSink;
}  // namespace httplib

namespace lacuna {

/// Passes responses to the HTTP library.
class AnswerWriter {
 public:
  /// `stopping`: streams end as soon as it is true. Both references outlive it.
  AnswerWriter(HttpMetrics& metrics, const std::atomic<bool>& stopping)
      : metrics_(metrics), stopping_(stopping) {}

  /// Sets `out` to the response to `sent`. `closes`: the connection ends with this response,
  /// because the next bytes on it are not a request.
  void put(Response response, bool closes, const httplib::Request& sent,
           httplib::Response& out) const;

 private:
  /// Returns bytes of a response from `offset` on, at least one and at most `length`; none if they
  /// cannot be read.
  using Source = std::function<std::string_view(std::size_t offset, std::size_t length)>;

  static Source source_of(Response response);
  void put_content(std::size_t size, Response response, bool closes, httplib::Response& out) const;
  void put_stream(Response response, bool closes, httplib::Response& out) const;
  void linger(const httplib::DataSink& client) const;

  HttpMetrics& metrics_;
  const std::atomic<bool>& stopping_;
};

}  // namespace lacuna
