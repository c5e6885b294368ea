#include "server/http.h"

#include <fmt/format.h>
#include <sys/eventfd.h>

#include <csignal>
#include <utility>

#include "server/answer_text.h"
#include "server/connection_pool.h"
#include "server/delivery.h"
#include "server/exchange.h"
#include "server/listener.h"
#include "server/log.h"
#include "server/reception.h"
#include "server/timed_socket.h"

namespace lacuna {
namespace {

/// Keeps a gauge up for as long as it lives.
class Counted {
 public:
  explicit Counted(HttpMetrics::Count& count) : count_(count) { ++count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --count_; }

 private:
  HttpMetrics::Count& count_;
};

/// The head of an answer, or of a bare 500 if it cannot be written.
std::string head_text(Response& response, bool to_http_1_0) {
  try {
    return answer_head(response, to_http_1_0);
  } catch (const std::logic_error& error) {
    log::error("an answer could not be made: {}", error.what());
    response = problem_response(HttpError(500, "The service failed; its log says more."), "");
    return answer_head(response, to_http_1_0);
  }
}

/// All of an answer but what streams.
Outgoing outgoing(Response& response, const RequestHead& head) {
  Outgoing out;
  out.text = head_text(response, head.is_http_1_0);
  if (head.method != "HEAD" && response.status != 304) {
    if (response.file) {
      out.file = std::move(response.file);
    } else if (!response.stream) {
      out.text += response.body;
    }
  }
  return out;
}

}  // namespace

class HttpServer::Engine {
 public:
  Engine(const HttpSettings& settings, HttpServer::Handler handler);
  ~Engine() { stop(); }

  std::string url() const { return listener_.url(); }
  void start();
  void stop();
  const HttpMetrics& metrics() const { return metrics_; }

 private:
  void serve(Arrival arrival);
  void stream(TimedSocket& socket, const std::string& head_text, const Response& response,
              bool to_http_1_0);
  void refuse(FileHandle socket, const HttpError& error);
  void note(const RequestHead& head, int status, PacedDeadline::Clock::time_point begin);

  const HttpSettings settings_;
  const HttpServer::Handler handler_;
  const Listener listener_;
  const FileHandle stop_;
  HttpMetrics metrics_;
  SlowSeats seats_;
  std::unique_ptr<Delivery> delivery_;
  std::unique_ptr<ConnectionPool> pool_;
  std::unique_ptr<Reception> reception_;
};

HttpServer::Engine::Engine(const HttpSettings& settings, HttpServer::Handler handler)
    : settings_(settings),
      handler_(std::move(handler)),
      listener_(settings.bind, settings.port),
      stop_(::eventfd(0, EFD_CLOEXEC)),
      seats_(settings.slow_seats(), metrics_.slow_seats) {
  std::signal(SIGPIPE, SIG_IGN);  // sendfile() has no MSG_NOSIGNAL
}

void HttpServer::Engine::start() {
  delivery_ = std::make_unique<Delivery>(settings_, metrics_);
  pool_ = std::make_unique<ConnectionPool>(settings_.threads, settings_.waiting, [this](Arrival a) {
    try {
      serve(std::move(a));
    } catch (const std::exception& error) {
      log::error("a connection failed: {}", error.what());
    }
  });
  reception_ = std::make_unique<Reception>(
      listener_, stop_.get(), settings_, metrics_, [this](Arrival& a) { return pool_->offer(a); },
      [this](FileHandle s, const HttpError& error) { refuse(std::move(s), error); });
}

void HttpServer::Engine::stop() {
  ::eventfd_write(stop_.get(), 1);
  if (reception_) reception_->join();
  if (pool_) pool_->stop();
  if (delivery_) delivery_->stop();
}

void HttpServer::Engine::serve(Arrival arrival) {
  const RequestHead head = std::move(arrival.head);
  const bool more_came = !arrival.framing.chunked && arrival.body.size() > arrival.framing.length;
  TimedSocket socket(std::move(arrival.socket), std::move(arrival.body), stop_.get(), settings_,
                     seats_);
  if (head.expects_continue()) socket.expect_continue();
  BodyReader body(head, arrival.framing, socket);
  Response response = respond(head, body, handler_);
  Outgoing out = outgoing(response, head);
  note(head, response.status, arrival.time);
  if (response.stream && head.method != "HEAD") {
    stream(socket, out.text, response, head.is_http_1_0);
    out.text.clear();
  }
  out.socket = socket.release();
  out.unread_input = more_came || !body.complete();
  delivery_->send(std::move(out));
}

void HttpServer::Engine::stream(TimedSocket& socket, const std::string& head_text,
                                const Response& response, bool to_http_1_0) {
  const Counted counted(metrics_.streams);
  const auto send = [&](const std::string& text) {
    metrics_.bytes_out += text.size();
    return socket.write(text);
  };
  try {
    if (!send(head_text)) return;
    while (!socket.stopping() && !socket.peer_gone()) {
      const auto text = response.stream();
      if (!text) {
        send(stream_text("", to_http_1_0));
        return;
      }
      if (!text->empty() && !send(stream_text(*text, to_http_1_0))) return;
    }
  } catch (const std::exception& error) {
    log::error("a stream ends early: {}", error.what());
  }
}

/// What is no request, or one too many.
void HttpServer::Engine::refuse(FileHandle socket, const HttpError& error) {
  Response response = problem_response(error, "");
  RequestHead head;
  Outgoing out = outgoing(response, head);
  out.socket = std::move(socket);
  out.unread_input = true;
  log::debug("refused: {} {}", error.status(), error.what());
  delivery_->send(std::move(out));
}

void HttpServer::Engine::note(const RequestHead& head, int status,
                              PacedDeadline::Clock::time_point begin) {
  const auto time = PacedDeadline::Clock::now() - begin;
  metrics_.answered(status, time);
  log::debug("{} {} {} {:.1f} ms", head.method, head.target.substr(0, head.target.find('?')),
             status, std::chrono::duration<double, std::milli>(time).count());
}

std::string HttpServer::answer(std::string_view received, const Handler& handler) {
  constexpr int max_texts = 16;
  RequestHead head;
  Response response;
  try {
    const std::size_t size = find_head_end(received, 0);
    if (size == 0) return {};
    head = parse_head(received.substr(0, size));
    TextSource source(received.substr(size));
    BodyReader body(head, body_framing(head), source);
    response = respond(head, body, handler);
  } catch (const HttpError& error) {
    response = problem_response(error, "");
  }
  std::string text = outgoing(response, head).text;
  for (int i = 0; response.stream && i < max_texts; ++i) {
    const auto next = response.stream();
    text += stream_text(next.value_or(""), head.is_http_1_0);
    if (!next) break;
  }
  return text;
}

HttpServer::HttpServer(const HttpSettings& settings, Handler handler)
    : engine_(std::make_unique<Engine>(settings, std::move(handler))) {}
HttpServer::~HttpServer() = default;
std::string HttpServer::url() const { return engine_->url(); }
void HttpServer::start() { engine_->start(); }
void HttpServer::stop() { engine_->stop(); }
const HttpMetrics& HttpServer::metrics() const { return engine_->metrics(); }

}  // namespace lacuna
