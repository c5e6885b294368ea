#include "server/http.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <fstream>

#include "jobs/spec/job_json.h"
#include "server/file_response.h"
#include "server/guard.h"
#include "server/router.h"
#include "tests/fuzz/input_file.h"

// The bytes that a client sends on one connection before it sends no more: answered by one HTTP/1.1
// answer of the service, or by nothing, and always closed.

namespace lacuna::fuzz {
namespace {

/// Of the service's own parts, but without jobs: what a request can reach, and nothing that lasts.
class Site {
 public:
  Site() {
    std::ofstream(folder_.dir() / "index.html") << std::string(5000, 'x');
    router_.add("GET", "/", [this](const Request& request, const Router::Parts&) {
      return file_response(request, folder_.dir(), "index.html", "text/html");
    });
    router_.add("POST", "/api/jobs", [](const Request& request, const Router::Parts&) {
      try {
        return text(write_job(parse_job(request.read_body(max_job_bytes))));
      } catch (const BadJob& bad) {
        throw HttpError(400, "The job is not valid.", bad.problems());
      }
    });
    router_.add("GET", "/api/jobs/{}/files/{}",
                [](const Request&, const Router::Parts& parts) { return text(parts[1]); });
    router_.add("GET", "/api/events", [](const Request&, const Router::Parts&) {
      Response response = text("");
      response.stream = [left = 3]() mutable -> std::optional<std::string> {
        if (left-- == 0) return std::nullopt;
        return "data: x\n\n";
      };
      return response;
    });
  }
  Response handle(const Request& request) const {
    check_sender(request);
    return router_.route(request);
  }

 private:
  static Response text(std::string body) {
    Response response;
    response.content_type = "text/plain";
    response.body = std::move(body);
    return response;
  }

  Folder folder_;
  Router router_;
};

HttpSettings settings() {
  HttpSettings s;
  s.port = 0;
  s.threads = 2;
  return s;
}

/// A service that runs until the end of the process.
class Running {
 public:
  Running() : server_(settings(), [this](const Request& r) { return site_.handle(r); }) {
    spdlog::set_level(spdlog::level::off);
    server_.start();
    const std::string url = server_.url();
    port_ = std::stoi(url.substr(url.rfind(':') + 1));
  }
  ~Running() { server_.stop(); }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  FileHandle connect() const {
    FileHandle client(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    // Closed by a reset: millions of connections must not stay behind in TIME_WAIT.
    const linger reset{1, 0};
    ::setsockopt(client.get(), SOL_SOCKET, SO_LINGER, &reset, sizeof reset);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    expect(
        ::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0,
        "the service takes connections");
    return client;
  }

 private:
  Site site_;
  HttpServer server_;
  int port_ = 0;
};

/// All that comes back until the service closes.
std::string answer_to(const FileHandle& client, std::span<const std::uint8_t> bytes) {
  ::send(client.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
  ::shutdown(client.get(), SHUT_WR);
  std::string answer;
  std::array<char, 8192> buffer;
  for (;;) {
    const ssize_t n = ::recv(client.get(), buffer.data(), buffer.size(), 0);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return answer;
    answer.append(buffer.data(), static_cast<std::size_t>(n));
  }
}

void check(std::string answer) {
  // An interim answer to `Expect: 100-continue`.
  if (answer.starts_with("HTTP/1.1 100 ")) answer.erase(0, answer.find("\r\n\r\n") + 4);
  if (answer.empty()) return;
  expect(answer.starts_with("HTTP/1.1 ") && answer.size() > 12, "an answer has a status line");
  expect(answer[9] >= '2' && answer[9] <= '5', "of a status that is final");
  const std::string status = answer.substr(9, 3);
  expect(status != "500", "no request makes the service fail");
  const std::size_t end = answer.find("\r\n\r\n");
  expect(end != std::string::npos, "its head is complete");
  expect(status == "503" || answer.substr(0, end).find("nosniff") != std::string::npos,
         "and forbids sniffing");
  // A request that the service stops reading must not be taken for the next one.
  expect(answer.find("\nHTTP/1.1 ", 0) == std::string::npos, "there is one answer a connection");
}

}  // namespace
}  // namespace lacuna::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace lacuna::fuzz;
  static const Running service;
  check(answer_to(service.connect(), {data, size}));
  return 0;
}
