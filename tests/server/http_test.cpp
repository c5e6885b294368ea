#include "server/http/http.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

#include "tests/server/loopback.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using namespace std::chrono_literals;
using test::Client;
using test::head;

constexpr std::size_t large = (32 << 20) - 4096;

/// Says what it was asked; /file is large, /store writes its body to a file, /events never ends,
/// /lazy takes no body.
class Handler {
 public:
  Response operator()(const Request& request) const {
    Response response;
    response.content_type = "text/plain";
    if (request.path == "/file") {
      response.file = FilePart{FileHandle(::open(file_.c_str(), O_RDONLY)), 1, large - 1};
    } else if (request.path == "/store") {
      const FileHandle out(
          ::open((folder_ / "stored").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600));
      response.body = std::to_string(request.read_body_to(out.get(), 1000));
    } else if (request.path == "/bad") {
      response.headers = {{"A", "b\r\nc: d"}};
    } else if (request.path == "/events") {
      response.stream = [first = true]() mutable -> std::optional<std::string> {
        std::this_thread::sleep_for(1ms);
        return std::exchange(first, false) ? "event" : "";
      };
    } else if (request.path == "/lazy") {
      response.status = 204;
      response.content_type.clear();
    } else {
      response.body = request.method + " " + request.read_body(1000);
    }
    return response;
  }
  std::string stored() const { return content_of(folder_ / "stored"); }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.write("file", std::string(large, 'f'));
};

HttpSettings patient() {
  HttpSettings s;
  s.port = 0;
  s.silence = 60'000ms;
  return s;
}

/// Everything goes to `handler`, which outlives it.
Router routes_to(const Handler& handler) {
  Router router;
  for (const std::string method : {"GET", "POST", "PUT", "PATCH", "DELETE"}) {
    for (const char* pattern : {"/", "/{name}"}) {
      router.add(method, pattern, {.for_programs = false},
                 [&handler](const Request& r, const Router::Parts&) { return handler(r); });
    }
  }
  return router;
}

class HttpTest : public ::testing::Test {
 protected:
  void start(const HttpSettings& settings = patient(), HttpServer::Admit admit = {}) {
    server_ =
        std::make_unique<HttpServer>(settings, routes_to(handler_), metrics_, std::move(admit));
    server_->bind();
    server_->start();
  }
  std::string answer(const std::string& text) const { return Client(*server_, text).read(); }
  int status(const std::string& text) const { return Client(*server_, text).status(); }
  /// Waits until a gauge has a value.
  static void reaches(const HttpMetrics::Count& count, std::uint64_t value) {
    // The limit only ends a test that would hang.
    for (int i = 0; i < 60'000 && count != value; ++i) std::this_thread::sleep_for(1ms);
    ASSERT_EQ(count, value);
  }

  const Handler handler_{};
  HttpMetrics metrics_;
  std::unique_ptr<HttpServer> server_;
};

TEST_F(HttpTest, MethodsReachHandlersWithTheirBodies) {
  start();
  for (const std::string method : {"POST", "PUT", "PATCH", "DELETE"}) {
    const auto expect_echo = [&](const std::string& headers, const std::string& body) {
      const std::string echo = "\r\n\r\n" + method + (body.empty() ? " " : " abc");
      const std::string text = Client(*server_, head(method + " /", headers) + body).read(echo);
      EXPECT_TRUE(text.ends_with(echo)) << text;
    };
    expect_echo("", "");
    expect_echo("Content-Length: 3\r\n", "abc");
    if (method == "DELETE") continue;  // whose chunks the library does not read
    expect_echo("Transfer-Encoding: chunked\r\n", "2\r\nab\r\n1\r\nc\r\n0\r\n\r\n");
  }
}

TEST_F(HttpTest, ABodyGoesToAFileUpToItsCap) {
  start();
  const std::string fits(1000, 'a');
  EXPECT_TRUE(answer(head("PUT /store", "Content-Length: 1000\r\n") + fits).ends_with("\r\n1000"));
  EXPECT_EQ(handler_.stored(), fits);
  EXPECT_EQ(status(head("PUT /store", "Transfer-Encoding: chunked\r\n") + "3e9\r\n" + fits + "a"),
            413);
  EXPECT_EQ(status(head("PUT /store", "Transfer-Encoding: chunked\r\n") + "3e8\r\n" + fits +
                   "\r\n1\r\na\r\n0\r\n\r\n"),
            413);
}

TEST_F(HttpTest, ABodyOverTheLimitIsRefusedBeforeItComes) {
  start();
  for (const char* line : {"PUT /store", "POST /"}) {
    EXPECT_EQ(status(head(line, "Content-Length: 1001\r\n")), 413) << line;
  }
  EXPECT_LT(handler_.stored().size(), 1U);
}

TEST_F(HttpTest, AConnectionCarriesManyRequests) {
  start();
  const Client client(*server_, "");
  for (int i = 0; i < 20; ++i) {
    client.send("POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc");
    const std::string text = client.read("POST abc");
    EXPECT_TRUE(text.starts_with("HTTP/1.1 200 "));
    EXPECT_EQ(text.find("Connection: close"), std::string::npos);
  }
  EXPECT_EQ(metrics_.accepted, 1U);
}

TEST_F(HttpTest, ABodyThatWasNotReadIsNeverTheNextRequest) {
  start(patient(), [](const Request& request) {
    if (request.headers.contains("origin")) throw HttpError(403, "");
  });
  // Beyond what the library reads ahead.
  const std::string hidden = std::string(5000, ' ') + head("GET /");
  const std::string length = "Content-Length: " + std::to_string(hidden.size()) + "\r\n";
  std::vector<Client> clients;
  for (const std::string& text : {
           "POST / HTTP/1.1\r\nOrigin: x\r\n" + length,
           "POST / HTTP/1.1\r\nContent-Type: multipart/form-data; boundary=a\r\n" + length,
           "POST / HTTP/1.1\r\nContent-Length: 0\r\n" + length,
           "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n" + length,
           "POST / HTTP/1.1\r\n" + length,
           "POST /lazy HTTP/1.1\r\n" + length,
           "POST /no/where HTTP/1.1\r\n" + length,
           "POST /?a=%zz HTTP/1.1\r\n" + length,
           "POST /" + std::string(9000, 'a') + " HTTP/1.1\r\n" + length,
           "POST / HTTP/1.1\r\nA: " + std::string(9000, 'a') + "\r\n" + length,
           "POST / HTTP/1.1\r\nRange: x\r\n" + length,
           "GET / HTTP/1.1\r\n" + length,
           "HEAD / HTTP/1.1\r\n" + length,
           "HEAD / HTTP/1.1\r\nRange: x\r\n" + length,
           "TRACE / HTTP/1.1\r\n" + length,
           "BREW / HTTP/1.1\r\n" + length,
           std::string("POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n1\r\naXX"),
       }) {
    clients.emplace_back(*server_, text + "\r\n" + hidden);
  }
  for (const Client& client : clients) {
    const std::string text = client.read();
    EXPECT_TRUE(text.starts_with("HTTP/1.1 ")) << text;
    EXPECT_EQ(text.find("HTTP/1.1 ", 1), std::string::npos) << text;
    EXPECT_NE(text.find("\r\nConnection: close\r\n"), std::string::npos) << text;
    EXPECT_NE(text.find("nosniff"), std::string::npos) << text;
  }
}

TEST_F(HttpTest, WhoFallsSilentIsSentAway) {
  HttpSettings settings = patient();
  settings.silence = 100ms;
  start(settings);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHo"), 400) << "head";
  EXPECT_EQ(status(head("POST /", "Content-Length: 3\r\n") + "a"), 400) << "body";
  EXPECT_EQ(status(head("POST /", "Transfer-Encoding: chunked\r\n") + "3\r\na"), 400) << "chunks";
  EXPECT_EQ(status(head("PUT /store", "Content-Length: 3\r\n") + "a"), 400) << "file";
  reaches(metrics_.connections, 0);
  const Client lazy(*server_, head("GET /file"));
  reaches(metrics_.requests[1], 1);  // its body is being sent: the connection is counted as open
  reaches(metrics_.connections, 0);
  EXPECT_LT(lazy.read().size(), large);
}

TEST_F(HttpTest, WhoComesWhileAllThreadsAreBusyWaits) {
  HttpSettings settings = patient();
  settings.threads = 2;
  start(settings);
  auto first = std::make_unique<Client>(*server_, "GET /");
  const Client second(*server_, "GET /");
  reaches(metrics_.connections, 2);
  const Client third(*server_, head("GET /"));
  first.reset();
  EXPECT_EQ(third.status(), 200);
}

TEST_F(HttpTest, StoppingWaitsForNoClient) {
  start();
  const Client silent(*server_, ""), half(*server_, "GET /"), lazy(*server_, head("GET /file"));
  const Client idle(*server_, "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  idle.read("GET ");
  const Client body(*server_, head("POST /", "Transfer-Encoding: chunked\r\n") + "3\r\na");
  const Client events(*server_, head("GET /events"));
  EXPECT_NE(events.read("event\r\n").find("event"), std::string::npos);
  reaches(metrics_.connections, 6);
  server_->stop();
  EXPECT_EQ(metrics_.connections, 0U);
  EXPECT_EQ(metrics_.streams, 0U);
  EXPECT_EQ(events.read(), "");
  EXPECT_NE(body.status(), 200);
}

TEST_F(HttpTest, ANewServerHasThePortOfOneThatHasStopped) {
  start();
  const Client client(*server_, "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n");
  client.read("GET ");
  HttpSettings settings = patient();
  const std::string url = server_->url();
  settings.port = std::stoi(url.substr(url.rfind(':') + 1));
  server_.reset();
  start(settings);
  EXPECT_EQ(status(head("GET /")), 200);
}

TEST_F(HttpTest, BytesThatAreNoTextMakeNothingFail) {
  start();
  for (const std::string line :
       {"GET /\xe9", "GET /a?\xe9", "GET /%e9", "GET /a?b=%e9", "\xe9 /\xe9"}) {
    const int answered = status(head(line, "A: \xe9\r\n"));
    EXPECT_TRUE(answered == 400 || answered == 404) << line;
  }
  EXPECT_EQ(status(head("GET /\xe9", "Range: \xe9\r\n")), 416);
}

TEST_F(HttpTest, AHeaderIsNotSplit) {
  start();
  const std::string text = answer(head("GET /bad"));
  EXPECT_NE(text.find(" 200 "), std::string::npos);
  EXPECT_EQ(text.find("c: d"), std::string::npos);
}

}  // namespace
}  // namespace lacuna
