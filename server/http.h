#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "server/http_metrics.h"
#include "server/message.h"
#include "server/settings.h"

namespace lacuna {

/// An HTTP/1.1 server that holds against slow, greedy and malformed clients. No thread that answers
/// requests waits for a client: one thread takes requests in until they are whole (Reception), one
/// sends what clients are slow to take (Delivery). The exceptions are large bodies, which take one
/// of a few slow seats, and event streams, whose number is limited. One request a connection: a
/// refused body can then never be taken for the next request.
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

  const HttpMetrics& metrics() const;

  /// What a connection that sends `received` and then nothing more is answered; nothing if its head
  /// is not whole. The same code as behind a socket, for tests. Of a stream, the first few texts.
  static std::string answer(std::string_view received, const Handler& handler);

 private:
  class Engine;
  std::unique_ptr<Engine> engine_;
};

}  // namespace lacuna
