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
/// event streams. What it lacks is added: a waiting room, where no client holds a thread until its
/// request has come; strict heads and chunks; deadlines, and a limited number of seats for slow
/// bodies and slow readers. One request a connection: a refused body can then never be taken for
/// the next request.
class HttpServer {
 public:
  /// Called before a route's handler: throws HttpError to refuse a request, or gives its answer.
  using Admit = std::function<std::optional<Response>(const Request&)>;

  /// Answers by the table of routes, on many threads. An HttpError that a handler throws becomes a
  /// problem+json answer, any other exception is logged and becomes a bare 500. `routes` is copied,
  /// `metrics` outlives the server.
  HttpServer(const HttpSettings& settings, const Router& routes, HttpMetrics& metrics,
             Admit admit = {});
  ~HttpServer();

  /// Takes the address; throws std::system_error, or std::invalid_argument for what is no address.
  void bind();
  /// "http://127.0.0.1:8017/"; once it is bound.
  std::string url() const;
  /// Begins to serve, on threads of its own.
  void start();
  /// Refuses what comes, ends streams, and waits for answers that are under way.
  void stop();

  /// What a connection that sends `received` and then nothing more is answered; nothing if its head
  /// is not whole. The same code as behind a socket, for tests; needs no bind(). Of a stream, the
  /// head; nothing longer than a socket's buffer.
  std::string answer(std::string_view received) const;

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace lacuna
