// The one source that includes cpp-httplib.
#include "server/http/http.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <httplib.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstring>
#include <ctime>
#include <map>
#include <system_error>
#include <utility>

#include "analysis/storage/passing_error.h"
#include "server/http/address.h"
#include "server/http/chunk_check.h"
#include "server/http/timed_socket.h"
#include "server/http/waiting_room.h"
#include "server/telemetry/log.h"

namespace lacuna {
namespace {

constexpr int backlog = 512;

// The page holds no foreign content and is nobody's frame. A figure of it in a frame elsewhere is
// not possible: its address says so only behind the #, which the service never sees.
const httplib::Headers headers_of_every_answer{
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; frame-ancestors 'none'; "
     "base-uri 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"}};

/// One request and its answer, as the library reads and writes them.
class Connection final : public httplib::Stream {
 public:
  /// `socket` outlives it.
  Connection(RequestHead head, TimedSocket& socket)
      : head_(std::move(head)), socket_(&socket), left_(head_.length) {}
  /// The answer to what is no request; it goes to text().
  explicit Connection(const HttpError& refusal)
      : head_{.text = "GET / HTTP/1.1\r\n\r\n"}, refusal_(&refusal) {}

  bool is_readable() const override { return true; }
  bool is_writable() const override { return true; }
  ssize_t read(char* data, std::size_t size) override;
  ssize_t write(const char* data, std::size_t size) override;
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return INVALID_SOCKET; }

  const RequestHead& head() const { return head_; }
  const HttpError* refusal() const { return refusal_; }
  TimedSocket& client() { return *socket_; }
  const std::string& text() const { return text_; }
  /// All of the body has been read.
  bool body_complete() const { return head_.chunked ? chunks_.complete() : left_ == 0; }

  httplib::Request* request = nullptr;  ///< the library's, from its head on
  std::optional<ByteRange> range;       ///< that the client asked for
  bool answered = false;                ///< the library's answer has been filled in
  std::function<void(int status)> on_answer;

 private:
  const RequestHead head_;
  TimedSocket* socket_ = nullptr;
  const HttpError* refusal_ = nullptr;
  std::string text_;
  std::size_t taken_ = 0;   ///< of the head
  std::uint64_t left_ = 0;  ///< of a body of known length
  ChunkCheck chunks_;
};

ssize_t Connection::read(char* data, std::size_t size) {
  if (taken_ < head_.text.size()) {
    const std::size_t n = head_.text.copy(data, size, taken_);
    taken_ += n;
    return static_cast<ssize_t>(n);
  }
  if (!head_.chunked) {
    const std::size_t n = socket_->read(data, std::min<std::uint64_t>(size, left_));
    left_ -= n;
    return static_cast<ssize_t>(n);
  }
  while (!chunks_.complete()) {
    const std::size_t n = socket_->read(data, size);
    const std::size_t kept = chunks_.pass(data, n);
    if (kept > 0 || n == 0) return static_cast<ssize_t>(kept);
  }
  return 0;
}

ssize_t Connection::write(const char* data, std::size_t size) {
  if (socket_ == nullptr) {
    text_.append(data, size);
  } else if (!socket_->write({data, size})) {
    return -1;
  }
  return static_cast<ssize_t>(size);
}

/// The one that the library works on, on this thread: it has no place for it in a request.
thread_local Connection* current = nullptr;

bool is_plain_path(std::string_view path) {
  return std::all_of(path.begin(), path.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::strchr("/._-~", c) != nullptr;
  });
}

[[noreturn]] void refuse_address() { throw HttpError(404, "There is no such address."); }

std::string path_as_sent(const httplib::Request& sent) {
  return sent.target.substr(0, sent.target.find('?'));
}

/// As check_head() wrote them, in lower case: without those that the library adds.
Headers headers_of(const httplib::Request& sent) {
  Headers headers;
  for (const auto& [name, value] : sent.headers) {
    if (name.starts_with("REMOTE_") || name.starts_with("LOCAL_")) continue;
    headers.emplace(name, value);
  }
  return headers;
}

/// Gives each piece of the body to `sink`. Throws as Request::read_body says.
template <class Sink>
void read_body(const httplib::ContentReader* reader, TimedSocket::Pace pace,
               std::uint64_t max_bytes, const Sink& sink) {
  Connection& c = *current;
  const HttpError too_large(413, fmt::format("The body is larger than {} bytes.", max_bytes));
  if (c.request->has_header("Content-Encoding")) {
    throw HttpError(415, "An encoded body (Content-Encoding) is not accepted.");
  }
  if (c.request->is_multipart_form_data()) throw HttpError(415, "A body of parts is not accepted.");
  if (reader == nullptr || !c.head().has_body()) return;
  if (c.head().chunked && c.request->method == "DELETE") {  // the library takes it for no body
    throw HttpError(411, "The body of a DELETE needs Content-Length.");
  }
  if (c.head().length > max_bytes) throw too_large;
  c.client().begin_body(pace, c.head().expects_continue);
  std::uint64_t total = 0;
  const bool whole = (*reader)([&](const char* data, std::size_t size) {
    if (size > max_bytes - total) throw too_large;
    total += size;
    sink(data, size);
    return true;
  });
  if (!whole) throw HttpError(400, "The body ended early.");
}

void write_all(int fd, const char* data, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t n = ::write(fd, data + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw std::system_error(errno, std::generic_category(), "cannot store a body");
    done += static_cast<std::size_t>(n);
  }
}

/// Throws HttpError 404 or 400.
Request request_of(const httplib::Request& sent, const httplib::ContentReader* reader) {
  Request request;
  request.method = sent.method;
  request.path = path_as_sent(sent);
  if (request.path.size() < sent.target.size()) {
    request.query =
        Query(std::string_view(sent.target).substr(request.path.size() + 1), sent.params);
  }
  request.headers = headers_of(sent);
  request.range = current->range;
  request.read_body = [reader](std::size_t max_bytes) {
    std::string text;
    read_body(reader, TimedSocket::Pace::total, max_bytes,
              [&](const char* data, std::size_t size) { text.append(data, size); });
    return text;
  };
  request.read_body_to = [reader](int fd, std::uint64_t max_bytes) {
    std::uint64_t total = 0;
    read_body(reader, TimedSocket::Pace::rate, max_bytes, [&](const char* data, std::size_t size) {
      write_all(fd, data, size);
      total += size;
    });
    return total;
  };
  return request;
}

/// The library drops what holds a line's end and lets other control characters pass.
bool headers_are_plain(const Response& response) {
  const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7f; };
  return std::none_of(response.headers.begin(), response.headers.end(), [&](const auto& header) {
    return std::any_of(header.second.begin(), header.second.end(), is_control);
  });
}

void put_stream(Response response, httplib::Response& out) {
  TimedSocket& client = current->client();
  if (current->request->method != "HEAD") client.begin_stream();
  auto provider = [next = std::move(response.stream), &client](std::size_t,
                                                               httplib::DataSink& sink) {
    if (client.gone()) return false;
    const auto text = next();
    if (!text) {
      sink.done();
    } else if (!text->empty()) {
      sink.write(text->data(), text->size());
    }
    return true;
  };
  if (current->request->version == "HTTP/1.0") {  // which knows no chunks
    out.set_content_provider(response.content_type, std::move(provider));
  } else {
    out.set_chunked_content_provider(response.content_type, std::move(provider));
  }
}

void put_file(Response response, httplib::Response& out) {
  if (response.range) {
    out.status = 206;
    current->request->ranges = {{response.range->first, response.range->last}};
  }
  const auto begin = static_cast<std::size_t>(response.file->offset);
  const auto size = static_cast<std::size_t>(response.file->length);
  out.set_content_provider(
      size, response.content_type,
      [begin, file = std::make_shared<FileHandle>(std::move(response.file->file))](
          std::size_t offset, std::size_t length, httplib::DataSink& sink) {
        std::array<char, 64 * 1024> buffer;
        const ssize_t n = ::pread(file->get(), buffer.data(), std::min(length, buffer.size()),
                                  static_cast<off_t>(begin + offset));
        return n > 0 && sink.write(buffer.data(), static_cast<std::size_t>(n));
      });
}

void put(Response response, httplib::Response& out) {
  if (!headers_are_plain(response)) {
    log::error("an answer could not be made: a header would hold a control character");
    response = problem_response(HttpError(500, "The service failed; see its log."), "");
  }
  current->answered = true;
  out.status = response.status;
  for (const auto& [name, value] : response.headers) out.set_header(name, value);
  if (response.stream) return put_stream(std::move(response), out);
  if (response.file && response.file->length > 0) return put_file(std::move(response), out);
  if (!response.content_type.empty()) out.set_header("Content-Type", response.content_type);
  out.body = std::move(response.body);
}

using Answer = std::function<Response(const Request&, const Router::Parts&)>;

/// cpp-httplib with the service's routes.
class Library final : public httplib::Server {
 public:
  Library(const Router& routes, HttpServer::Admit admit);

  /// A listening socket that does not block; `port` becomes the one that it has. Throws
  /// std::system_error.
  FileHandle listen_on(const std::string& address, int& port);
  void answer(Connection& connection);
  void end_streams() { svr_sock_ = INVALID_SOCKET; }

 private:
  void add(const std::string& method, const std::string& pattern, const Answer& answer);
  void add_refusals(const Router& routes);
  void respond(const httplib::Request& sent, httplib::Response& out,
               const httplib::ContentReader* reader, const Answer& answer) const;
  static void complete(const httplib::Request& sent, httplib::Response& out);

  const HttpServer::Admit admit_;
};

/// "/jobs/{id}" as a regular expression; paths hold no other special character than the point.
std::string expression(const Router::Route& route) {
  std::string result;
  for (const std::string& part : route.pattern) {
    if (&part != &route.pattern.front()) result += '/';
    if (part.starts_with('{')) {
      result += "([^/]+)";
      continue;
    }
    for (const char c : part) result += c == '.' ? std::string("\\.") : std::string(1, c);
  }
  return result;
}

Library::Library(const Router& routes, HttpServer::Admit admit) : admit_(std::move(admit)) {
  set_default_headers(headers_of_every_answer);
  set_post_routing_handler(complete);
  // What the library refuses by itself, such as a range that it cannot read.
  const HandlerWithResponse refuse = [](const httplib::Request& sent, httplib::Response& out) {
    if (current->answered) return HandlerResponse::Unhandled;
    put(problem_response(HttpError(out.status, "The request is malformed."), path_as_sent(sent)),
        out);
    return HandlerResponse::Handled;
  };
  set_error_handler(refuse);
  for (const Router::Route& route : routes.routes()) {
    add(route.method, expression(route),
        [route](const Request& request, const Router::Parts& parts) {
          if (!route.doc.any_characters && !is_plain_path(request.path)) refuse_address();
          if (route.doc.for_programs) check_query(request.query, route.doc);
          return route.handler(request, parts);
        });
  }
  add_refusals(routes);
  svr_sock_ = 0;  // streams go on for as long as this is a socket
}

/// The library looks at one method's routes only: so each path refuses the methods that it lacks,
/// and everything else is refused before the library reads a body.
void Library::add_refusals(const Router& routes) {
  std::map<std::string, std::vector<std::string>> methods;
  for (const Router::Route& route : routes.routes()) {
    methods[expression(route)].push_back(route.method);
  }
  for (const std::string method : {"GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}) {
    for (const auto& [pattern, known] : methods) {
      if (std::find(known.begin(), known.end(), method) != known.end()) continue;
      std::string allowed;
      for (const std::string& name : known) {
        allowed += (allowed.empty() ? "" : ", ") + (name == "GET" ? "GET, HEAD" : name);
      }
      add(method, pattern, [allowed](const Request& request, const Router::Parts&) -> Response {
        if (!is_plain_path(request.path)) refuse_address();
        throw HttpError(405,
                        fmt::format("{} is not possible here, only {}.", request.method, allowed))
            .with("Allow", allowed);
      });
    }
    add(method, ".*", [](const Request&, const Router::Parts&) -> Response { refuse_address(); });
  }
}

void Library::add(const std::string& method, const std::string& pattern, const Answer& answer) {
  const Handler plain = [this, answer](const httplib::Request& sent, httplib::Response& out) {
    respond(sent, out, nullptr, answer);
  };
  const HandlerWithContentReader reads =
      [this, answer](const httplib::Request& sent, httplib::Response& out,
                     const httplib::ContentReader& reader) { respond(sent, out, &reader, answer); };
  if (method == "GET") Get(pattern, plain);
  if (method == "OPTIONS") Options(pattern, plain);
  if (method == "POST") Post(pattern, reads);
  if (method == "PUT") Put(pattern, reads);
  if (method == "PATCH") Patch(pattern, reads);
  if (method == "DELETE") Delete(pattern, reads);
}

void Library::respond(const httplib::Request& sent, httplib::Response& out,
                      const httplib::ContentReader* reader, const Answer& answer) const {
  const std::string path = current->refusal() != nullptr ? "" : path_as_sent(sent);
  Response response;
  try {
    if (current->refusal() != nullptr) throw HttpError(*current->refusal());
    const Request request = request_of(sent, reader);
    auto early = admit_ ? admit_(request) : std::nullopt;
    Router::Parts parts(sent.matches.begin() + 1, sent.matches.end());
    response = early ? std::move(*early) : answer(request, parts);
  } catch (const HttpError& error) {
    response = problem_response(error, path);
  } catch (const std::system_error& error) {
    log::error("{} {}: {}", sent.method, path, error.what());
    response = problem_response(
        may_pass(error) ? storage_error(error, "The service cannot use its files for now")
                        : HttpError(500, "The service failed; its log says more."),
        path);
  } catch (const std::exception& error) {
    log::error("{} {}: {}", sent.method, path, error.what());
    response = problem_response(HttpError(500, "The service failed; see its log."), path);
  }
  put(std::move(response), out);
}

/// The last look at an answer's head.
void Library::complete(const httplib::Request&, httplib::Response& out) {
  out.set_header("Date",
                 fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT", fmt::gmtime(std::time(nullptr))));
  if (out.status == 204 || out.status == 304) out.headers.erase("Content-Length");
  if (!out.content_provider_) out.headers.erase("Accept-Ranges");  // set for HEAD, of whatever
  if (current->on_answer) current->on_answer(out.status);
}

FileHandle Library::listen_on(const std::string& address, int& port) {
  const std::string host = numeric_address(address);
  set_socket_options([](socket_t socket) {
    const int yes = 1;  // a restart need not wait for old connections to be forgotten
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  });
  errno = 0;
  const int bound = port == 0 ? bind_to_any_port(host) : (bind_to_port(host, port) ? port : -1);
  FileHandle listener(bound < 0 ? -1 : svr_sock_.load());
  if (!listener || ::listen(listener.get(), backlog) != 0 ||
      ::fcntl(listener.get(), F_SETFD, FD_CLOEXEC) != 0 ||
      ::fcntl(listener.get(), F_SETFL, O_NONBLOCK) != 0) {
    throw std::system_error(errno, std::generic_category(),
                            fmt::format("cannot listen on {} port {}", address, port));
  }
  port = bound;
  return listener;
}

void Library::answer(Connection& connection) {
  const auto take_request = [&](httplib::Request& request) {
    connection.request = &request;
    if (request.ranges.size() == 1) {
      connection.range = ByteRange{request.ranges.front().first, request.ranges.front().second};
    }
    request.ranges.clear();  // a range is of a file, and of no other answer
  };
  Connection* const outer = std::exchange(current, &connection);
  bool closed = false;
  try {
    process_request(connection, true, closed, take_request);
  } catch (const std::exception& error) {  // the head has gone out already
    log::error("an answer ends early: {}", error.what());
  }
  current = outer;
}

}  // namespace

class HttpServer::Engine {
 public:
  Engine(const HttpSettings& settings, const Router& routes, HttpMetrics& metrics, Admit admit)
      : settings_(settings),
        metrics_(metrics),
        library_(routes, std::move(admit)),
        stop_(::eventfd(0, EFD_CLOEXEC)),
        seats_(settings.slow_seats(), settings.reading_bytes, metrics_),
        shared_{settings_, metrics_, seats_, stop_.get()} {}
  ~Engine() { stop(); }

  void bind() {
    port_ = settings_.port;
    listener_ = library_.listen_on(settings_.bind, port_);
  }
  std::string url() const {
    const bool is_v6 = settings_.bind.find(':') != std::string::npos;
    return fmt::format("http://{}:{}/", is_v6 ? "[" + settings_.bind + "]" : settings_.bind, port_);
  }
  void start();
  void stop();
  std::string answer(std::string_view received);

 private:
  std::string refusal(const HttpError& error);
  bool offer(Arrival& arrival);
  void serve(Arrival arrival);

  const HttpSettings settings_;
  HttpMetrics& metrics_;
  Library library_;
  FileHandle listener_;
  int port_ = 0;
  const FileHandle stop_;
  SlowSeats seats_;
  const TimedSocket::Shared shared_;
  std::atomic<bool> stopping_{false};
  std::atomic<std::size_t> waiting_{0};  ///< whole requests that no thread has taken yet
  std::unique_ptr<httplib::ThreadPool> threads_;
  std::unique_ptr<WaitingRoom> room_;
};

void HttpServer::Engine::start() {
  threads_ = std::make_unique<httplib::ThreadPool>(settings_.threads);
  room_ = std::make_unique<WaitingRoom>(
      listener_.get(), settings_, metrics_, [this](Arrival& a) { return offer(a); },
      [this](const HttpError& error) {
        log::debug("refused: {} {}", error.status(), error.what());
        return refusal(error);
      });
}

void HttpServer::Engine::stop() {
  if (stopping_.exchange(true)) return;
  ::eventfd_write(stop_.get(), 1);
  library_.end_streams();
  if (threads_) threads_->shutdown();
  room_.reset();
}

/// For the waiting room.
bool HttpServer::Engine::offer(Arrival& arrival) {
  if (stopping_ || waiting_ >= settings_.waiting) return false;
  ++waiting_;
  threads_->enqueue([this, taken = std::make_shared<Arrival>(std::move(arrival))] {
    --waiting_;
    if (!stopping_) serve(std::move(*taken));
  });
  return true;
}

void HttpServer::Engine::serve(Arrival arrival) {
  const bool more_came = !arrival.head.chunked && arrival.body.size() > arrival.head.length;
  TimedSocket socket(std::move(arrival.socket), std::move(arrival.body), shared_);
  Connection connection(std::move(arrival.head), socket);
  connection.on_answer = [&](int status) {
    const auto time = PacedDeadline::Clock::now() - arrival.time;
    metrics_.answered(status, time);
    log::debug("{} {} {} {:.1f} ms", connection.request->method, path_as_sent(*connection.request),
               status, std::chrono::duration<double, std::milli>(time).count());
  };
  library_.answer(connection);
  FileHandle open = socket.release();
  if (more_came || !connection.body_complete()) {
    room_->linger(std::move(open));
  } else {
    ::shutdown(open.get(), SHUT_WR);
  }
}

std::string HttpServer::Engine::refusal(const HttpError& error) {
  Connection connection(error);
  library_.answer(connection);
  return connection.text();
}

std::string HttpServer::Engine::answer(std::string_view received) {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "cannot make a pair of sockets");
  }
  FileHandle here(ends[0]);
  const FileHandle there(ends[1]);
  ::shutdown(there.get(), SHUT_WR);
  try {
    const std::size_t size = find_head_end(received, 0);
    if (size == 0) return {};
    TimedSocket socket(std::move(here), std::string(received.substr(size)), shared_);
    Connection connection(check_head(received.substr(0, size)), socket);
    library_.answer(connection);
    ::shutdown(socket.release().get(), SHUT_WR);
  } catch (const HttpError& error) {
    return refusal(error);
  }
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t n = 0; (n = ::recv(there.get(), buffer.data(), buffer.size(), 0)) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(n));
  }
  return text;
}

HttpServer::HttpServer(const HttpSettings& settings, const Router& routes, HttpMetrics& metrics,
                       Admit admit)
    : engine_(std::make_unique<Engine>(settings, routes, metrics, std::move(admit))) {}
HttpServer::~HttpServer() = default;
void HttpServer::bind() { engine_->bind(); }
std::string HttpServer::url() const { return engine_->url(); }
void HttpServer::start() { engine_->start(); }
void HttpServer::stop() { engine_->stop(); }
std::string HttpServer::answer(std::string_view received) const {
  return engine_->answer(received);
}

}  // namespace lacuna
