#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/http_metrics.h"
#include "server/http/message.h"
#include "server/http/router.h"
#include "server/settings/http_settings.h"

namespace lacuna {

/// An HTTP/1.1 server on cpp-httplib, which http.cpp alone includes: the library parses requests,
/// decodes bodies and queries, matches routes, works out ranges, and writes answers, files and
/// event streams. This class adds a waiting room, so that no client holds a thread before its
/// request has arrived; strict heads and chunks; deadlines, and a limited number of seats for slow
/// bodies and slow readers. One request per connection, so that a refused body can never be taken
/// for the next request.
class HttpServer {
 public:
  /// Called before a route's handler: throws HttpError to refuse a request, or returns its
  /// response.
  using Admit = std::function<std::optional<Response>(const Request&)>;

  /// Serves the routes on many threads. An HttpError of a handler becomes a problem+json response;
  /// any other exception is logged and becomes a 500 without details. `routes` is copied; `metrics`
  /// must outlive the server.
  HttpServer(const HttpSettings& settings, const Router& routes, HttpMetrics& metrics,
             Admit admit = {});
  ~HttpServer();

  /// Binds the address; throws std::system_error, or std::invalid_argument for an invalid address.
  void bind();
  /// "http://127.0.0.1:8017/"; once it is bound.
  std::string url() const;
  /// Starts serving, on its own threads.
  void start();
  /// Refuses new requests, ends streams, and waits for responses in progress.
  void stop();

  /// The response to a connection that sends `received` and nothing more; empty if its head is
  /// incomplete. Runs the same code as behind a socket, for tests; needs no bind(). Of a stream,
  /// only the head; at most the size of a socket's buffer.
  std::string answer(std::string_view received) const;

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace lacuna
