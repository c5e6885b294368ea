#include "server/http.h"

#include <fmt/format.h>
#include <httplib.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <thread>

#include "server/connection_pool.h"
#include "server/listener.h"
#include "server/timed_socket.h"

namespace lacuna {
namespace {

constexpr std::size_t max_target_bytes = 1024;
constexpr std::size_t file_chunk_bytes = 64 * 1024;

const httplib::Headers every_answer{
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; frame-ancestors 'none'; "
     "base-uri 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"},
};

/// What one connection is doing; httplib's callbacks find it through `current`.
struct Connection {
  TimedSocket socket;
  bool unread_input = false;
};
thread_local Connection* current = nullptr;

/// A TimedSocket in the form that httplib reads and writes.
class SocketStream : public httplib::Stream {
 public:
  explicit SocketStream(TimedSocket& socket) : socket_(socket) {}
  bool is_readable() const override { return true; }
  bool is_writable() const override { return !socket_.timed_out(); }
  ssize_t read(char* data, std::size_t size) override { return socket_.read(data, size); }
  ssize_t write(const char* data, std::size_t size) override { return socket_.write(data, size); }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return socket_.fd(); }

 private:
  TimedSocket& socket_;
};

bool is_plain(const std::string& path) {
  return std::all_of(path.begin(), path.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::strchr("/._-~", c) != nullptr;
  });
}

std::string lower_case(std::string s) {
  for (char& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

/// Whether a body follows, by the framing headers; throws HttpError where they are not clear.
bool has_body(const Request& request) {
  const auto encoding = request.header("transfer-encoding");
  const auto length = request.header("content-length");
  if (encoding && length) throw HttpError(400, "Content-Length and Transfer-Encoding together.");
  if (encoding && lower_case(*encoding) != "chunked") {
    throw HttpError(400, "Transfer-Encoding may only be \"chunked\".");
  }
  if (length && (length->empty() || length->size() > 18 ||
                 length->find_first_not_of("0123456789") != std::string::npos)) {
    throw HttpError(400, "Content-Length is not a number of bytes.");
  }
  return encoding || (length && std::stoull(*length) > 0);
}

std::string read_body(const Request& request, const httplib::ContentReader& reader,
                      std::size_t max_bytes) {
  const auto too_large = [&] {
    return HttpError(413, fmt::format("The body is larger than {} bytes.", max_bytes));
  };
  if (request.header("content-encoding")) {
    throw HttpError(415, "An encoded body (Content-Encoding) is not accepted.");
  }
  // httplib calls a receiver of parts that nobody gave it.
  if (request.header("content-type").value_or("").starts_with("multipart/form-data")) {
    throw HttpError(415, "A body of several parts is not accepted.");
  }
  if (!has_body(request)) return {};
  if (const auto length = request.header("content-length")) {
    if (std::stoull(*length) > max_bytes) throw too_large();
  }
  // The smallest chunks carry one byte in seven.
  current->socket.expect_body(8 * max_bytes + 4096);
  std::string body;
  bool fits = true;
  const bool complete = reader([&](const char* data, std::size_t size) {
    fits = size <= max_bytes - body.size();
    if (fits) body.append(data, size);
    return fits;
  });
  if (!fits) throw too_large();
  if (!complete && current->socket.timed_out()) throw HttpError(408, "The body came too slowly.");
  if (!complete) throw HttpError(400, "The body ended early or its chunks are malformed.");
  current->unread_input = false;
  return body;
}

void send_file(httplib::Response& out, FilePart part, const std::string& type) {
  if (part.length == 0) return out.set_content("", type);
  const auto shared = std::make_shared<FilePart>(std::move(part));
  out.set_content_provider(
      static_cast<std::size_t>(shared->length), type,
      [shared](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        std::array<char, file_chunk_bytes> buffer;
        const ssize_t n =
            ::pread(shared->file.get(), buffer.data(), std::min(length, buffer.size()),
                    shared->offset + static_cast<off_t>(offset));
        return n > 0 && sink.write(buffer.data(), static_cast<std::size_t>(n));
      });
}

void send_stream(httplib::Response& out, Response& in) {
  current->socket.stream_answer();
  out.set_chunked_content_provider(
      in.content_type,
      [next = std::move(in.stream), connection = current](std::size_t, httplib::DataSink& sink) {
        if (connection->socket.peer_gone()) return false;
        const auto text = next();
        if (!text) {
          sink.done();
          return true;
        }
        return text->empty() || sink.write(text->data(), text->size());
      });
}

void fill(httplib::Response& out, Response in) {
  out.status = in.status;
  for (const auto& [name, value] : in.headers) out.set_header(name, value);
  if (in.file) {
    send_file(out, std::move(*in.file), in.content_type);
  } else if (in.stream) {
    send_stream(out, in);
  } else if (!in.content_type.empty()) {
    out.set_content(in.body, in.content_type);
  }
}

}  // namespace

class HttpServer::Engine : private httplib::Server {
 public:
  Engine(const HttpSettings& settings, HttpServer::Handler handler);
  ~Engine() override { stop_serving(); }

  std::string url() const { return listener_.url(); }
  void start();
  void stop_serving();

 private:
  void accept_connections();
  void serve(FileHandle connection);
  void answer(const httplib::Request& in, httplib::Response& out,
              const httplib::ContentReader* reader) const;
  Response handled(const Request& request) const;

  const HttpSettings settings_;
  const HttpServer::Handler handler_;
  const Listener listener_;
  const FileHandle stop_;
  std::unique_ptr<ConnectionPool> pool_;
  std::thread acceptor_;
};

HttpServer::Engine::Engine(const HttpSettings& settings, HttpServer::Handler handler)
    : settings_(settings),
      handler_(std::move(handler)),
      listener_(settings.bind, settings.port),
      stop_(::eventfd(0, EFD_CLOEXEC)) {
  set_default_headers(every_answer);
  set_pre_routing_handler([this](const httplib::Request& in, httplib::Response& out) {
    const std::string path = in.target.substr(0, in.target.find('?'));
    if (in.target.size() > max_target_bytes) {
      fill(out, problem_response(HttpError(414, "The address is too long."), ""));
    } else if (!is_plain(path)) {
      fill(out, problem_response(HttpError(404, "There is nothing here."), path));
    } else if (in.method == "POST") {
      return HandlerResponse::Unhandled;
    } else {
      answer(in, out, nullptr);
    }
    return HandlerResponse::Handled;
  });
  Post(".*", [this](const httplib::Request& in, httplib::Response& out,
                    const httplib::ContentReader& reader) { answer(in, out, &reader); });
  set_exception_handler(
      [](const httplib::Request&, httplib::Response& out, const std::exception_ptr&) {
        spdlog::error("an answer could not be made");
        fill(out, problem_response(HttpError(500, "The service failed; its log says more."), ""));
      });
  // What the library refuses by itself has no body yet.
  set_error_handler(HandlerWithResponse([](const httplib::Request&, httplib::Response& out) {
    if (!out.body.empty()) return HandlerResponse::Unhandled;
    const HttpError error = current->socket.timed_out()
                                ? HttpError(408, "The request came too slowly.")
                                : HttpError(out.status, "The request is malformed.");
    fill(out, problem_response(error, ""));
    return HandlerResponse::Handled;
  }));
}

Response HttpServer::Engine::handled(const Request& request) const {
  try {
    return handler_(request);
  } catch (const HttpError& error) {
    return problem_response(error, request.path);
  } catch (const std::exception& error) {
    spdlog::error("{} {}: {}", request.method, request.path, error.what());
    return problem_response(HttpError(500, "The service failed; its log says more."), request.path);
  }
}

void HttpServer::Engine::answer(const httplib::Request& in, httplib::Response& out,
                                const httplib::ContentReader* reader) const {
  Request request;
  request.method = in.method;
  request.path = in.target.substr(0, in.target.find('?'));
  for (const auto& [name, value] : in.headers) request.headers.emplace(lower_case(name), value);
  current->unread_input =
      request.headers.contains("content-length") || request.headers.contains("transfer-encoding");
  request.read_body = [&](std::size_t max_bytes) {
    return reader ? read_body(request, *reader, max_bytes) : std::string();
  };
  fill(out, handled(request));
}

void HttpServer::Engine::serve(FileHandle connection) {
  Connection state{TimedSocket(std::move(connection), stop_.get(), settings_)};
  current = &state;
  SocketStream stream(state.socket);
  bool closed = false;
  try {
    process_request(stream, true, closed, [](httplib::Request& request) {
      // Ranges are answered by file_response; nothing is compressed on the way to this machine.
      request.ranges.clear();
      request.headers.erase("Accept-Encoding");
    });
  } catch (const std::exception& error) {
    spdlog::error("a connection failed: {}", error.what());
  }
  state.socket.finish(state.unread_input);
  current = nullptr;
}

void HttpServer::Engine::start() {
  svr_sock_ = listener_.fd();  // by which httplib knows that it is not shutting down
  pool_ = std::make_unique<ConnectionPool>(settings_.threads, settings_.waiting,
                                           [this](FileHandle c) { serve(std::move(c)); });
  acceptor_ = std::thread([this] { accept_connections(); });
}

void HttpServer::Engine::accept_connections() {
  constexpr std::string_view busy =
      "HTTP/1.1 503 Service Unavailable\r\nContent-Length: 0\r\nRetry-After: 1\r\n"
      "Connection: close\r\n\r\n";
  std::array<pollfd, 2> fds{{{listener_.fd(), POLLIN, 0}, {stop_.get(), POLLIN, 0}}};
  for (;;) {
    ::poll(fds.data(), fds.size(), -1);
    if (fds[1].revents != 0) return;
    FileHandle connection = listener_.accept();
    if (!connection) {
      // Out of descriptors or memory: the connection stays in the line, so do not spin on it.
      if (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM) {
        ::poll(&fds[1], 1, 50);
      }
    } else if (!pool_->offer(connection)) {
      ::send(connection.get(), busy.data(), busy.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    }
  }
}

void HttpServer::Engine::stop_serving() {
  svr_sock_ = INVALID_SOCKET;
  ::eventfd_write(stop_.get(), 1);
  if (acceptor_.joinable()) acceptor_.join();
  if (pool_) pool_->stop();
}

HttpServer::HttpServer(const HttpSettings& settings, Handler handler)
    : engine_(std::make_unique<Engine>(settings, std::move(handler))) {}
HttpServer::~HttpServer() = default;
std::string HttpServer::url() const { return engine_->url(); }
void HttpServer::start() { engine_->start(); }
void HttpServer::stop() { engine_->stop_serving(); }

}  // namespace lacuna
