#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <thread>

#include "server/http/http.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

using namespace std::chrono_literals;

constexpr auto forever = 60'000ms;
constexpr std::size_t large = (32 << 20) - 4096;

/// Says what it was asked; /large and /file are large, /store writes its body to a file.
class Handler {
 public:
  Response operator()(const Request& request) const {
    Response response;
    response.content_type = "text/plain";
    if (request.path == "/large") {
      response.body.assign(large, 'x');
    } else if (request.path == "/file") {
      response.file = FilePart{FileHandle(::open(file_.c_str(), O_RDONLY)), 1, large - 1};
    } else if (request.path == "/store") {
      const FileHandle out(
          ::open((folder_ / "stored").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600));
      response.body = std::to_string(request.read_body_to(out.get(), 1000));
    } else if (request.path == "/bad") {
      response.headers = {{"A", "b\r\nc: d"}};
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
  s.threads = 34;  // two slow seats
  s.head_time = s.body_time = s.answer_time = forever;
  return s;
}

class Client {
 public:
  Client(const HttpServer& server, std::string_view text)
      : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const std::string url = server.url();
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(std::stoi(url.substr(url.rfind(':') + 1))));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    send(text);
  }
  void send(std::string_view text) const {
    ::send(socket_.get(), text.data(), text.size(), MSG_NOSIGNAL);
  }
  /// All that comes until the service closes.
  std::string read() const {
    std::string text;
    std::vector<char> buffer(1 << 20);
    for (;;) {
      const ssize_t n = ::recv(socket_.get(), buffer.data(), buffer.size(), 0);
      if (n <= 0) return text;
      text.append(buffer.data(), static_cast<std::size_t>(n));
    }
  }
  int status() const {
    const std::string text = read();
    return text.size() > 12 ? std::stoi(text.substr(9, 3)) : 0;
  }

 private:
  FileHandle socket_;
};

std::string head(const std::string& line, const std::string& more = "") {
  return line + " HTTP/1.1\r\nHost: localhost\r\n" + more + "\r\n";
}

/// Everything goes to `handler`, which outlives it.
template <class H>
Router routes_to(const H& handler) {
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
  void start(const HttpSettings& settings) {
    server_ = std::make_unique<HttpServer>(settings, routes_to(handler_), metrics_);
    server_->bind();
    server_->start();
  }
  int status(const std::string& text) const { return Client(*server_, text).status(); }
  /// Waits until a gauge or counter has a value.
  static void reaches(const HttpMetrics::Count& count, std::uint64_t value) {
    for (int i = 0; i < 6000 && count != value; ++i) std::this_thread::sleep_for(10ms);
    ASSERT_EQ(count, value);
  }

  const Handler handler_{};
  HttpMetrics metrics_;
  std::unique_ptr<HttpServer> server_;
};

TEST_F(HttpTest, MethodsReachHandlersWithTheirBodies) {
  start(patient());
  for (const std::string method : {"POST", "PUT", "PATCH", "DELETE"}) {
    EXPECT_TRUE(Client(*server_, head(method + " /", "Content-Length: 3\r\n") + "abc")
                    .read()
                    .ends_with(method + " abc"));
    const std::string chunked =
        head(method + " /", "Transfer-Encoding: chunked\r\n") + "2\r\nab\r\n1\r\nc\r\n0\r\n\r\n";
    if (method == "DELETE") {
      EXPECT_EQ(status(chunked), 411);
    } else {
      EXPECT_TRUE(Client(*server_, chunked).read().ends_with(method + " abc"));
    }
    EXPECT_TRUE(Client(*server_, head(method + " /")).read().ends_with(method + " "));
  }
}

TEST_F(HttpTest, ABodyGoesToAFileUpToItsCap) {
  start(patient());
  const std::string fits(1000, 'a');
  EXPECT_TRUE(Client(*server_, head("PUT /store", "Content-Length: 1000\r\n") + fits)
                  .read()
                  .ends_with("\r\n1000"));
  EXPECT_EQ(handler_.stored(), fits);
  EXPECT_EQ(status(head("PUT /store", "Content-Length: 1001\r\n") + fits + "a"), 413);
  EXPECT_EQ(status(head("PUT /store", "Transfer-Encoding: chunked\r\n") + "3e9\r\n" + fits + "a"),
            413);
  EXPECT_EQ(status(head("PUT /store", "Transfer-Encoding: chunked\r\n") + "3e8\r\n" + fits +
                   "\r\n1\r\na\r\n0\r\n\r\n"),
            413);
}

TEST_F(HttpTest, WhatComesTooSlowlyIsToldSo) {
  HttpSettings settings = patient();
  settings.head_time = settings.body_time = 100ms;
  start(settings);
  EXPECT_EQ(status("GET / HTTP/1.1\r\nHo"), 408) << "head";
  EXPECT_EQ(status(head("POST /", "Content-Length: 3\r\n") + "a"), 408) << "small body";
  EXPECT_EQ(status(head("POST /", "Transfer-Encoding: chunked\r\n") + "3\r\na"), 408) << "chunks";
  EXPECT_EQ(status(head("PUT /store", "Transfer-Encoding: chunked\r\n") + "3\r\na"), 408) << "file";
  EXPECT_EQ(status(""), 0) << "who says nothing is told nothing";
}

TEST_F(HttpTest, NewcomersAreServedHoweverManyConnectionsAreParked) {
  HttpSettings settings = patient();
  settings.parked = 4;
  start(settings);
  std::vector<Client> parked;
  parked.reserve(6);
  for (int i = 0; i < 6; ++i) parked.emplace_back(*server_, i % 2 == 0 ? "GET / HT" : "");
  EXPECT_EQ(parked[0].status(), 503) << "the oldest goes first";
  EXPECT_EQ(parked[1].status(), 503);
  EXPECT_EQ(status(head("GET /")), 200);
  parked[4].send("TP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_EQ(parked[4].status(), 200) << "who is newer stays";
}

TEST_F(HttpTest, SlowBodiesTakeALimitedNumberOfSeats) {
  start(patient());
  const std::string slow = head("POST /", "Transfer-Encoding: chunked\r\n") + "3\r\na";
  const Client first(*server_, slow), second(*server_, slow);
  reaches(metrics_.slow_seats, 2);
  const std::string third = Client(*server_, slow).read();
  EXPECT_NE(third.find(" 503 "), std::string::npos);
  EXPECT_NE(third.find("\r\nRetry-After: "), std::string::npos);
  EXPECT_EQ(status(slow + "bc\r\n0\r\n\r\n"), 200) << "what has come needs no seat";
  first.send("bc\r\n0\r\n\r\n");
  EXPECT_EQ(first.status(), 200);
  reaches(metrics_.slow_seats, 1);
}

TEST_F(HttpTest, SlowReadersTakeALimitedNumberOfSeats) {
  start(patient());
  std::vector<Client> lazy;
  lazy.reserve(20);
  for (int i = 0; i < 20; ++i) {
    lazy.emplace_back(*server_, head(i % 2 == 0 ? "GET /large" : "GET /file"));
    reaches(metrics_.slow_seats, std::min(i + 1, 2));
    reaches(metrics_.given_up, std::max(i - 1, 0));
  }
  EXPECT_EQ(status(head("GET /")), 200);
  EXPECT_LT(lazy[0].read().size(), large) << "who has taken nothing for longest goes first";
  const std::string file = lazy[19].read();
  EXPECT_EQ(file.size() - file.find("\r\n\r\n") - 4, large - 1);
  EXPECT_TRUE(file.ends_with("ff"));
  const std::string text = lazy[18].read();
  EXPECT_EQ(text.size() - text.find("\r\n\r\n") - 4, large);
  reaches(metrics_.slow_seats, 0);
}

TEST_F(HttpTest, AnswersToSlowReadersTakeALimitedAmountOfMemory) {
  HttpSettings settings = patient();
  settings.threads = 64;
  start(settings);
  std::vector<Client> lazy;
  lazy.reserve(5);
  for (int i = 0; i < 5; ++i) lazy.emplace_back(*server_, head("GET /large"));
  reaches(metrics_.given_up, 3);
  EXPECT_EQ(metrics_.slow_seats, 2U) << "of 32 MiB each, in 64 MiB";
}

TEST_F(HttpTest, ReadersThatTakeTooLittleAreGivenUp) {
  HttpSettings settings = patient();
  settings.answer_time = 100ms;
  start(settings);
  const Client lazy(*server_, head("GET /file"));
  reaches(metrics_.given_up, 1);
  EXPECT_LT(lazy.read().size(), large);
}

TEST_F(HttpTest, StoppingWaitsForNoClient) {
  start(patient());
  const Client silent(*server_, ""), half(*server_, "GET /"), lazy(*server_, head("GET /file"));
  const Client body(*server_, head("POST /", "Transfer-Encoding: chunked\r\n") + "3\r\na");
  reaches(metrics_.slow_seats, 2);
  server_->stop();
  EXPECT_NE(body.status(), 200);
}

TEST_F(HttpTest, AnAnswerThatCannotBeWrittenIsA500) {
  start(patient());
  const std::string answer = Client(*server_, head("GET /bad")).read();
  EXPECT_NE(answer.find(" 500 "), std::string::npos);
  EXPECT_EQ(answer.find("c: d"), std::string::npos);
}

TEST(HttpAnswer, NeedsNoSocket) {
  const auto echo = [](const Request& request) {
    Response response;
    response.body = request.path + " " + request.read_body(10);
    return response;
  };
  HttpMetrics metrics;
  const HttpServer server({}, routes_to(echo), metrics);
  const auto answer = [&](const std::string& text) { return server.answer(text); };
  EXPECT_EQ(answer("GET / HTTP/1.1\r\n"), "");
  EXPECT_TRUE(answer(head("GET /a?b")).ends_with("\r\n\r\n/a "));
  EXPECT_TRUE(answer(head("PUT /", "Content-Length: 2\r\n") + "abc").ends_with("/ ab"));
  EXPECT_TRUE(answer(head("PUT /", "Content-Length: 4\r\n") + "abc").starts_with("HTTP/1.1 400 "));
  EXPECT_TRUE(answer(head("GET /a?b=%")).starts_with("HTTP/1.1 400 "));
}

}  // namespace
}  // namespace lacuna
