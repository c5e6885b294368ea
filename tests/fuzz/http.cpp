#include "server/http/http.h"

#include <fstream>
#include <string_view>
#include <utility>

#include "jobs/spec/job_json.h"
#include "server/http/access.h"
#include "server/http/file_response.h"
#include "tests/fuzz/input_file.h"

// The bytes that a client sends on one connection before it sends no more: answered by one HTTP/1.1
// answer of the service, or by nothing where the head is not whole.

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
  std::string answer(std::string_view received) {
    if (!server_) {
      server_.emplace(HttpSettings{}, router_, metrics_,
                      [this](const Request& request) { return access_.admit(request); });
    }
    return server_->answer(received);
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
  Access access_{"127.0.0.1", {}, [](const std::string& path) { return path == "/"; }};
  HttpMetrics metrics_;
  std::optional<HttpServer> server_;  // once all routes are there
};

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
  static Site site;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  check(site.answer(bytes));
  return 0;
}
