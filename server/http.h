#pragma once

#include <functional>
#include <memory>
#include <string>

#include "server/message.h"
#include "server/settings.h"

namespace lacuna {

/// An HTTP/1.1 server that holds against slow, greedy and malformed clients: cpp-httplib parses
/// requests and writes answers; connections, deadlines, bodies and errors are kept here (FACTS,
/// section 4, lists why). One request a connection: a refused body can then never be taken for the
/// next request. Every answer forbids sniffing, framing, referrers and foreign scripts.
class HttpServer {
 public:
  using Handler = std::function<Response(const Request&)>;

  /// Binds and listens; throws std::system_error or std::invalid_argument. `handler` is called on
  /// many threads; an HttpError it throws becomes a problem+json answer, any other exception is
  /// logged and becomes a bare 500.
  HttpServer(const HttpSettings& settings, Handler handler);
  ~HttpServer();

  std::string url() const;
  /// Begins to serve, on threads of its own.
  void start();
  /// Refuses what comes, ends streams, and waits for answers that are under way.
  void stop();

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace lacuna
