#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "server/http/answer_writer.h"
#include "server/http/connection_threads.h"
#include "server/http/http_metrics.h"
#include "server/http/message.h"
#include "server/http/router.h"
#include "server/settings/http_settings.h"

namespace httplib {
class ContentReader;
class Server;
}  // namespace httplib

namespace lacuna {

/// An HTTP/1.1 server: cpp-httplib, which listens, parses requests, matches routes, keeps
/// connections alive, reads bodies, applies timeouts and writes responses. This class adds a thread
/// for each connection, the refusal of requests that the library would misread, size limits of
/// bodies, and errors as problem+json.
class HttpServer {
 public:
  /// Called when a request's head has arrived; throws HttpError to refuse it.
  using Admit = std::function<void(const Request&)>;

  /// An HttpError of a handler becomes a problem+json response; any other exception is logged and
  /// becomes a 500 without details. `routes` is copied; `metrics` must outlive the server.
  HttpServer(HttpSettings settings, const Router& routes, HttpMetrics& metrics, Admit admit = {});
  ~HttpServer();

  /// Binds the address; throws std::system_error, or std::invalid_argument for an invalid address.
  void bind();
  /// "http://127.0.0.1:8017/"; after bind().
  std::string url() const;
  /// Starts serving on its own threads.
  void start();
  /// Refuses new requests, ends streams, waits a second for responses in progress, and closes every
  /// connection.
  void stop();

 private:
  using Handle = std::function<void(const httplib::Request&, httplib::Response&,
                                    const httplib::ContentReader&)>;
  void configure();
  void add(const std::string& method, const std::string& expression, const Handle& handle);
  void refuse_rest(const Router& routes);
  void listen();
  void admit(const httplib::Request& sent);
  void respond(const Router::Route& route, const httplib::Request& sent, httplib::Response& out,
               const httplib::ContentReader& reader) const;
  void complete(const httplib::Request& sent, httplib::Response& out);

  const HttpSettings settings_;
  HttpMetrics& metrics_;
  const Admit admit_;
  std::atomic<bool> stopping_{false}, listening_{false};
  const AnswerWriter writer_;
  ConnectionThreads threads_;
  const std::unique_ptr<httplib::Server> server_;
  int listener_ = -1;  ///< of the library
  int port_ = 0;
  std::thread listener_thread_;
};

}  // namespace lacuna
