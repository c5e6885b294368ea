// Only this source and answer_writer.cpp include cpp-httplib.
#include "server/http/http.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <ctime>
#include <filesystem>
#include <regex>
#include <set>
#include <system_error>
#include <utility>

#include "base/log/log.h"
#include "base/storage/passing_error.h"
#include "server/http/address.h"
#include "server/http/guard.h"

namespace lacuna {
namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

// In the kernel: hundreds of clients may connect at once.
constexpr int backlog = 512;
// Otherwise each client that reads nothing could occupy megabytes of kernel memory.
constexpr int send_buffer = 256 * 1024;
// The library requires a limit; there is no reason for one.
constexpr std::size_t requests_a_connection = 1'000'000;
// An idle connection holds a thread, which polls it a hundred times a second: long enough for the
// requests of a page, shorter than browsers' timeouts.
constexpr time_t idle_seconds = 5;
constexpr std::size_t max_target_bytes = 1024;
// Time that stop() waits for responses in progress.
constexpr auto stop_time = 1s;

constexpr const char* problem_type = "application/problem+json";

// The page has no foreign content and may not be framed. Figures cannot be framed elsewhere either:
// only the fragment after the #, which the service never receives, distinguishes them.
const httplib::Headers headers_of_every_answer{
    {"Content-Security-Policy",
     "default-src 'self'; img-src 'self' blob: data:; object-src 'none'; frame-ancestors 'none'; "
     "base-uri 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cross-Origin-Resource-Policy", "same-origin"}};

/// Connects the library to the threads.
class Tasks final : public httplib::TaskQueue {
 public:
  Tasks(ConnectionThreads& threads, HttpMetrics& metrics) : threads_(threads), metrics_(metrics) {}

  using Enqueued = decltype(std::declval<httplib::TaskQueue&>().enqueue({}));  // void, later bool
  Enqueued enqueue(std::function<void()> serve) override {
    ++metrics_.accepted;
    threads_.start([&metrics = metrics_, serve = std::move(serve)] {
      const Counted open(metrics.connections);
      serve();
    });
    return Enqueued(true);
  }
  /// The library calls it when it stops accepting, also after an error: connections continue.
  void shutdown() override {}

 private:
  ConnectionThreads& threads_;
  HttpMetrics& metrics_;
};

/// The data of a request, from its head to the end of its response.
struct Exchange {
  explicit Exchange(HttpMetrics& metrics) : in_progress(metrics.in_progress) {}
  Clock::time_point begin = Clock::now();
  Counted in_progress;
  bool closes = false;  ///< its body was not read: the next bytes are not a request
};
/// For the request that this thread answers: the library cannot store it.
thread_local std::optional<Exchange> exchange;

bool is_plain_path(std::string_view path) {
  return std::all_of(path.begin(), path.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("/._-~").find(c) != std::string_view::npos;
  });
}

[[noreturn]] void refuse_address() { throw HttpError(404, "There is no such address."); }

std::string path_as_sent(const httplib::Request& sent) {
  return sent.target.substr(0, sent.target.find('?'));
}

/// A request's head, without its query.
Request head_of(const httplib::Request& sent) {
  Request request;
  request.method = sent.method;
  request.path = path_as_sent(sent);
  for (const auto& [name, value] : sent.headers) {
    if (name.starts_with("REMOTE_") || name.starts_with("LOCAL_"))
      continue;  // added by the library
    request.headers.emplace(lower_case(name), value);
  }
  if (sent.ranges.size() == 1) {
    request.range = ByteRange{sent.ranges.front().first, sent.ranges.front().second};
  }
  return request;
}

/// Passes each piece of the body to `sink`. Throws as Request::read_body.
template <class Sink>
void read_body(const Request& head, const httplib::ContentReader& reader, std::uint64_t max_bytes,
               const Sink& sink) {
  if (!announces_body(head)) return;  // the library would read until the connection ends
  const HttpError too_large(413, fmt::format("The body is larger than {} bytes.", max_bytes));
  if (std::stoull(head.header("content-length").value_or("0")) > max_bytes) throw too_large;
  std::uint64_t total = 0;
  const bool whole = reader([&](const char* data, std::size_t size) {
    if (size > max_bytes - total) throw too_large;
    total += size;
    sink(data, size);
    return true;
  });
  if (!whole) throw HttpError(400, "The body ends early, pauses too long, or is malformed.");
}

void write_all(int fd, const char* data, std::size_t size) {
  for (std::size_t done = 0; done < size;) {
    const ssize_t n = ::write(fd, data + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw std::system_error(errno, std::generic_category(), "cannot store a body");
    done += static_cast<std::size_t>(n);
  }
}

/// "/jobs/{id}" as a regular expression; paths contain no special character but the dot.
std::string expression(const Router::Route& route) {
  static const std::regex point("\\."), name("\\{[^}]*\\}");
  return std::regex_replace(std::regex_replace(route.pattern, point, "\\."), name, "([^/]+)");
}

/// The response to an exception. `path`: of the request.
Response answer_to(const std::exception_ptr& thrown, const std::string& path) {
  try {
    std::rethrow_exception(thrown);
  } catch (const HttpError& error) {
    return problem_response(error, path);
  } catch (const std::system_error& error) {
    log::error("{}: {}", path, error.what());
    if (may_pass(error)) {
      return problem_response(
          storage_error(error, "The service cannot access its files at present"), path);
    }
  } catch (const std::exception& error) {
    log::error("{}: {}", path, error.what());
  }
  return problem_response(HttpError(500, "Internal error; see the service's log."), path);
}

/// The local port of a connection; 0 for any other descriptor.
int port_of_connection(int fd) {
  sockaddr_storage own{}, peer{};
  socklen_t size = sizeof own, peer_size = sizeof peer;
  if (::getsockname(fd, reinterpret_cast<sockaddr*>(&own), &size) != 0 ||
      ::getpeername(fd, reinterpret_cast<sockaddr*>(&peer), &peer_size) != 0 ||
      (own.ss_family != AF_INET && own.ss_family != AF_INET6)) {
    return 0;
  }
  return ntohs(reinterpret_cast<const sockaddr_in&>(own).sin_port);  // at the same offset for IPv6
}

/// Shuts down the connections; the library does not expose their descriptors.
void shut_connections(int port) {
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", unreadable)) {
    const int fd = std::stoi(entry.path().filename());
    if (port_of_connection(fd) == port) ::shutdown(fd, SHUT_RDWR);
  }
}

}  // namespace

HttpServer::HttpServer(HttpSettings settings, const Router& routes, HttpMetrics& metrics,
                       Admit admit)
    : settings_(std::move(settings)),
      metrics_(metrics),
      admit_(std::move(admit)),
      writer_(metrics, stopping_),
      threads_(settings_.threads),
      server_(std::make_unique<httplib::Server>()) {
  configure();
  for (const Router::Route& route : routes.routes()) {
    add(route.method, expression(route),
        [this, route](const auto& sent, auto& out, const auto& reader) {
          respond(route, sent, out, reader);
        });
  }
  refuse_rest(routes);
}

HttpServer::~HttpServer() { stop(); }

void HttpServer::configure() {
  server_->new_task_queue = [this] { return new Tasks(threads_, metrics_); };
  server_->set_default_headers(headers_of_every_answer);
  server_->set_tcp_nodelay(true);  // responses and events are written whole
  server_->set_keep_alive_max_count(requests_a_connection);
  server_->set_keep_alive_timeout(idle_seconds);
  server_->set_read_timeout(settings_.silence);
  server_->set_write_timeout(settings_.silence);
  server_->set_socket_options([this](socket_t listener) {
    listener_ = listener;
    const int yes = 1;  // a restart need not wait for old connections in TIME_WAIT
    ::setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    ::setsockopt(listener, SOL_SOCKET, SO_SNDBUF, &send_buffer, sizeof send_buffer);
  });
  using Handled = httplib::Server::HandlerResponse;
  server_->set_pre_routing_handler([this](const httplib::Request& sent, httplib::Response&) {
    admit(sent);
    return Handled::Unhandled;
  });
  server_->set_exception_handler(
      [this](const httplib::Request& sent, httplib::Response& out, const std::exception_ptr& e) {
        writer_.put(answer_to(e, path_as_sent(sent)), exchange->closes, sent, out);
      });
  // For requests that the library itself refuses, anywhere in a head: close the connection.
  const httplib::Server::HandlerWithResponse refused = [this](const auto& sent, auto& out) {
    if (out.get_header_value("Content-Type") == problem_type) return Handled::Unhandled;
    const HttpError error(out.status, "The request is malformed, or ends early.");
    writer_.put(problem_response(error, path_as_sent(sent)), true, sent, out);
    return Handled::Handled;
  };
  server_->set_error_handler(refused);
  server_->set_post_routing_handler(
      [this](const httplib::Request& sent, httplib::Response& out) { complete(sent, out); });
  server_->set_logger([](const httplib::Request&, const httplib::Response&) { exchange.reset(); });
}

void HttpServer::add(const std::string& method, const std::string& expression,
                     const Handle& handle) {
  const auto without_body = [handle](const httplib::Request& sent, httplib::Response& out) {
    handle(sent, out, httplib::ContentReader({}, {}));
  };
  if (method == "GET") server_->Get(expression, without_body);
  if (method == "OPTIONS") server_->Options(expression, without_body);
  if (method == "POST") server_->Post(expression, handle);
  if (method == "PUT") server_->Put(expression, handle);
  if (method == "PATCH") server_->Patch(expression, handle);
  if (method == "DELETE") server_->Delete(expression, handle);
}

/// Refuses requests without a route, whose bodies the library would read into memory.
void HttpServer::refuse_rest(const Router& routes) {
  std::vector<std::pair<std::regex, std::string>> known;
  for (const Router::Route& route : routes.routes()) {
    known.emplace_back(expression(route), route.method);
  }
  for (const std::string method : {"GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}) {
    add(method, ".*", [known](const httplib::Request& sent, auto&, auto&) {
      std::set<std::string> allowed;
      for (const auto& [pattern, possible] : known) {
        if (!std::regex_match(sent.path, pattern)) continue;
        allowed.insert(possible);
        if (possible == "GET") allowed.insert("HEAD");
      }
      if (allowed.empty() || !is_plain_path(path_as_sent(sent))) refuse_address();
      const std::string list = fmt::format("{}", fmt::join(allowed, ", "));
      throw HttpError(405, fmt::format("{} is not allowed here; allowed: {}.", sent.method, list))
          .with("Allow", list);
    });
  }
}

/// Throws HttpError for a refused request.
void HttpServer::admit(const httplib::Request& sent) {
  const Request head = head_of(sent);
  exchange.emplace(metrics_).closes = announces_body(head) || stopping_;
  if (stopping_) throw HttpError(503, "The service is shutting down.");
  check_framing(head);
  if (sent.target.size() > max_target_bytes) throw HttpError(414, "The address is too long.");
  // The library supports more methods, and would read their bodies into memory.
  for (const char* method : {"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}) {
    if (sent.method != method) continue;
    if (admit_) admit_(head);
    return;
  }
  throw HttpError(501, "The method is not supported.");
}

void HttpServer::respond(const Router::Route& route, const httplib::Request& sent,
                         httplib::Response& out, const httplib::ContentReader& reader) const {
  Request request = head_of(sent);
  if (!route.doc.any_characters && !is_plain_path(request.path)) refuse_address();
  if (request.path.size() < sent.target.size()) {
    request.query = Query(std::string_view(sent.target).substr(request.path.size() + 1));
  }
  if (route.doc.for_programs) check_query(request.query, route.doc);
  // The library accepts any bytes as the end of chunks, so the next bytes may be anything.
  const auto has_read = [&] { exchange->closes = request.headers.contains("transfer-encoding"); };
  request.read_body = [&](std::size_t max_bytes) {
    std::string text;
    read_body(request, reader, max_bytes,
              [&](const char* data, std::size_t size) { text.append(data, size); });
    has_read();
    return text;
  };
  request.read_body_to = [&](int fd, std::uint64_t max_bytes) {
    std::uint64_t total = 0;
    read_body(request, reader, max_bytes, [&](const char* data, std::size_t size) {
      write_all(fd, data, size);
      total += size;
    });
    has_read();
    return total;
  };
  Response response = route.handler(request, {sent.matches.begin() + 1, sent.matches.end()});
  writer_.put(std::move(response), exchange->closes, sent, out);
}

/// Completes a response's head.
void HttpServer::complete(const httplib::Request& sent, httplib::Response& out) {
  out.set_header("Date",
                 fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT", fmt::gmtime(std::time(nullptr))));
  if (out.status == 204 || out.status == 304) out.headers.erase("Content-Length");
  if (out.has_header("Connection")) {
    out.headers.erase("Keep-Alive");
    out.headers.erase("Connection");  // keep only one of ours and the library's
    out.set_header("Connection", "close");
  }
  const auto time = exchange ? Clock::now() - exchange->begin : Clock::duration{};
  metrics_.answered(out.status, time);
  log::debug("{} {} {} {:.1f} ms", sent.method, path_as_sent(sent), out.status,
             std::chrono::duration<double, std::milli>(time).count());
}

void HttpServer::bind() {
  const std::string host = numeric_address(settings_.bind);
  const int wanted = port_ > 0 ? port_ : settings_.port;
  errno = 0;
  int port = wanted;
  if (wanted == 0) {
    port = server_->bind_to_any_port(host);
  } else if (!server_->bind_to_port(host, wanted)) {
    port = -1;
  }
  if (port < 0 || ::listen(listener_, backlog) != 0) {
    throw std::system_error(errno, std::generic_category(),
                            fmt::format("cannot listen on {} port {}", settings_.bind, wanted));
  }
  port_ = port;
}

std::string HttpServer::url() const {
  const bool is_v6 = settings_.bind.find(':') != std::string::npos;
  return fmt::format("http://{}:{}/", is_v6 ? "[" + settings_.bind + "]" : settings_.bind, port_);
}

void HttpServer::start() {
  listening_ = true;
  listener_thread_ = std::thread([this] { listen(); });
}

/// The library stops listening when no descriptor or memory is left for a connection, which is
/// transient.
void HttpServer::listen() {
  while (!stopping_) {
    server_->listen_after_bind();
    for (bool bound = false; !bound && !stopping_;) {
      log::error("the service cannot accept connections; retrying");
      std::this_thread::sleep_for(100ms);
      try {
        bind();
        bound = true;
      } catch (const std::system_error& error) {
        log::error("{}", error.what());
      }
    }
  }
  listening_ = false;
}

void HttpServer::stop() {
  if (stopping_.exchange(true) || !listener_thread_.joinable()) return;
  const auto end = Clock::now() + stop_time;
  while (metrics_.in_progress > 0 && Clock::now() < end) std::this_thread::sleep_for(1ms);
  for (bool stopped = false; listening_ || threads_.count() > 0;) {
    if (!stopped && server_->is_running()) {
      server_->stop();
      stopped = true;
    }
    shut_connections(port_);
    std::this_thread::sleep_for(1ms);
  }
  listener_thread_.join();
}

}  // namespace lacuna
