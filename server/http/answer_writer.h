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

/// Hands responses to the HTTP library.
class AnswerWriter {
 public:
  /// `stopping`: streams end as soon as it is true. Both references outlive it.
  AnswerWriter(HttpMetrics& metrics, const std::atomic<bool>& stopping)
      : metrics_(metrics), stopping_(stopping) {}

  /// Makes `out` the response to `sent`. `closes`: what follows on the connection is not a next
  /// request, so the connection ends with this answer.
  void put(Response response, bool closes, const httplib::Request& sent,
           httplib::Response& out) const;

 private:
  /// Some bytes of an answer from `offset` on, at most `length` and at least one; none: they cannot
  /// be read.
  using Source = std::function<std::string_view(std::size_t offset, std::size_t length)>;

  static Source source_of(Response response);
  void put_content(std::size_t size, Response response, bool closes, httplib::Response& out) const;
  void put_stream(Response response, bool closes, httplib::Response& out) const;
  void linger(const httplib::DataSink& client) const;

  HttpMetrics& metrics_;
  const std::atomic<bool>& stopping_;
};

}  // namespace lacuna
