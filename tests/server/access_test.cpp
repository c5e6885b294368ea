#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "server/http/access.h"
#include "tests/temporary_folder.h"

namespace lacuna {
namespace {

const std::string secret = "0123456789abcdef";

Request request(std::string method, std::string path, Headers headers = {}) {
  Request r;
  r.method = std::move(method);
  r.path = std::move(path);
  r.headers = std::move(headers);
  if (!r.headers.contains("host")) r.headers.emplace("host", "localhost");
  return r;
}

int status_of_error(const std::function<void()>& call) {
  try {
    call();
    return 200;
  } catch (const HttpError& error) {
    return error.status();
  }
}

class AccessTest : public ::testing::Test {
 protected:
  AccessTest() : file_(folder_.path() / "token") { write(secret + "\n"); }
  void write(const std::string& text, mode_t mode = 0600) {
    std::ofstream(file_) << text;
    ::chmod(file_.c_str(), mode);
  }
  Access make() {
    return {"127.0.0.1", {.token_file = file_, .hosts = {}}, [](const std::string& path) {
              return path == "/";
            }};
  }
  static int admit(Access& access, const Request& r) {
    return status_of_error([&] { access.admit(r); });
  }
  /// The answer of the route /api/session.
  static Response session(Access& access, const Request& r) {
    access.admit(r);
    Router router;
    access.add_to(router);
    for (const Router::Route& route : router.routes()) {
      if (route.method == r.method) return route.handler(r, {});
    }
    throw HttpError(405, "");
  }
  static Response login(Access& access, const std::string& token) {
    Request r = request("POST", "/api/session", {{"content-type", "application/json"}});
    r.read_body = [token](std::size_t) { return "{\"token\": \"" + token + "\"}"; };
    return session(access, r);
  }
  /// The cookie that the right token gets, without its attributes.
  static std::string cookie(Access& access) {
    for (const auto& [name, value] : login(access, secret).headers) {
      if (name == "Set-Cookie") return value.substr(0, value.find(';'));
    }
    return {};
  }

  TemporaryFolder folder_;
  const std::filesystem::path file_;
};

TEST_F(AccessTest, ComparesTheWholeToken) {
  const Token token("abcabc");
  EXPECT_TRUE(token.is("abcabc"));
  for (const char* wrong : {"", "a", "abc", "abcab", "abcabcabc", "abcabd", "xbcabc", "ABCABC"}) {
    EXPECT_FALSE(token.is(wrong)) << wrong;
  }
  EXPECT_FALSE(token.is(std::string_view("abcabc\0", 7)));
}

TEST_F(AccessTest, TheTokenFileMustBeOursAlone) {
  EXPECT_TRUE(Token::read(file_).is(secret));
  write(secret);
  EXPECT_TRUE(Token::read(file_).is(secret)) << "without an end of line";
  write(std::string(256, 'x') + "\n");
  EXPECT_NO_THROW(Token::read(file_));
  for (const std::string& text :
       {std::string("short\n"), std::string(257, 'x'), secret + "\n\n", secret + " \n",
        secret + "\r\n", secret + "\nmore", std::string(), secret + "\xc3\xa9", secret + "%41"}) {
    write(text);
    EXPECT_THROW(Token::read(file_), std::runtime_error) << text;
  }
  for (const mode_t mode : {0640, 0604, 0660, 0620}) {
    write(secret, mode);
    EXPECT_THROW(Token::read(file_), std::runtime_error) << mode;
  }
  write(secret, 0400);
  EXPECT_NO_THROW(Token::read(file_));
  const auto link = folder_.path() / "link";
  std::filesystem::create_symlink(file_, link);
  EXPECT_THROW(Token::read(link), std::runtime_error);
  const auto fifo = folder_.path() / "fifo";
  ASSERT_EQ(::mkfifo(fifo.c_str(), 0600), 0);
  EXPECT_THROW(Token::read(fifo), std::runtime_error);
  EXPECT_THROW(Token::read(folder_.path()), std::runtime_error);
  EXPECT_THROW(Token::read(folder_.path() / "none"), std::runtime_error);
}

TEST_F(AccessTest, WhoShowsNoTokenSeesThePageAndTheHealthOnly) {
  Access access = make();
  for (const char* open : {"/", "/health"}) {
    EXPECT_EQ(admit(access, request("GET", open)), 200) << open;
    EXPECT_EQ(admit(access, request("HEAD", open)), 200) << open;
    EXPECT_EQ(admit(access, request("POST", open)), 401) << open;
  }
  for (const char* closed : {"/metrics", "/api/jobs", "/api/info", "/openapi.json", "/nothing"}) {
    EXPECT_EQ(admit(access, request("GET", closed)), 401) << closed;
  }
  const auto with = [&](const std::string& value) {
    return admit(access, request("GET", "/api/jobs", {{"authorization", value}}));
  };
  EXPECT_EQ(with("Bearer " + secret), 200);
  EXPECT_EQ(with("bearer " + secret), 200);
  for (const std::string wrong :
       {"Bearer", "Bearer ", "Basic eDp5", "Bearer  0123456789abcdef", "Bearer 0123456789abcdeg"}) {
    EXPECT_EQ(with(wrong), 401) << wrong;
  }
  EXPECT_EQ(with(secret), 401);
}

TEST_F(AccessTest, ASessionStandsForTheToken) {
  Access access = make();
  const std::string id = cookie(access);
  EXPECT_EQ(id.size(), std::string("lacuna_session=").size() + 64);
  const auto with = [&](const std::string& method, Headers more) {
    return admit(access, request(method, "/api/jobs", std::move(more)));
  };
  EXPECT_EQ(with("GET", {{"cookie", id}}), 200);
  EXPECT_EQ(with("GET", {{"cookie", "a=b; " + id + "; c=d"}}), 200);
  EXPECT_EQ(with("GET", {{"cookie", "x" + id}}), 401);
  EXPECT_EQ(with("GET", {{"cookie", id + "0"}}), 401);
  EXPECT_EQ(with("GET", {{"cookie", "lacuna_session="}}), 401);
  // A browser sends cookies without being asked: the page must have sent what changes something.
  EXPECT_EQ(with("POST", {{"cookie", id}}), 403);
  EXPECT_EQ(with("POST", {{"cookie", id}, {"sec-fetch-site", "same-origin"}}), 200);
  EXPECT_EQ(with("POST", {{"cookie", id}, {"sec-fetch-site", "same-site"}}), 403);
  EXPECT_EQ(with("DELETE", {{"cookie", id}, {"origin", "http://localhost"}}), 200);
  EXPECT_EQ(with("DELETE", {{"cookie", id}, {"origin", "http://evil.example"}}), 403);
  const auto end =
      request("DELETE", "/api/session", {{"cookie", id}, {"origin", "http://localhost"}});
  EXPECT_EQ(session(access, end).status, 204);
  EXPECT_EQ(with("GET", {{"cookie", id}}), 401) << "it is over";
}

TEST_F(AccessTest, TheOldestSessionIsForgotten) {
  Access access = make();
  const std::string first = cookie(access);
  const std::string second = cookie(access);
  for (std::size_t i = 1; i < Sessions::max_sessions; ++i) cookie(access);
  EXPECT_EQ(admit(access, request("GET", "/api/jobs", {{"cookie", first}})), 401);
  EXPECT_EQ(admit(access, request("GET", "/api/jobs", {{"cookie", second}})), 200);
}

TEST_F(AccessTest, ManyWrongTokensAreRefusedAndTheRightOnePasses) {
  Access access = make();
  const std::string id = cookie(access);
  int refused = 0;
  const auto wrong = [&] { return status_of_error([&] { login(access, "wrong"); }); };
  for (int i = 0; i < 1000; ++i) refused += wrong() == 429 ? 1 : 0;
  ASSERT_GT(refused, 500);
  bool is_refused = false;
  for (int i = 0; i < 1000 && !is_refused; ++i) is_refused = wrong() == 429;
  ASSERT_TRUE(is_refused);
  EXPECT_EQ(admit(access, request("GET", "/", {})), 200);
  EXPECT_EQ(admit(access, request("GET", "/api/jobs", {{"cookie", id}})), 200) << "sessions go on";
  EXPECT_FALSE(cookie(access).empty());
  EXPECT_EQ(admit(access, request("GET", "/api/jobs", {{"authorization", "Bearer " + secret}})),
            200);
}

TEST(Guard, KnowsEachLoopbackAddressThatItIsBoundTo) {
  Guard("127.0.0.2", {}).check(request("GET", "/", {{"host", "127.0.0.2:8017"}}));
  EXPECT_THROW(Guard("127.0.0.1", {}).check(request("GET", "/", {{"host", "127.0.0.2:8017"}})),
               HttpError);
}

TEST(Guard, KnowsTheNamesOfTheService) {
  const Guard guard("192.0.2.7", {"render.example", "Other.Example:444"});
  const auto check = [&](const std::string& host) {
    return status_of_error([&] { guard.check(request("GET", "/", {{"host", host}})); });
  };
  for (const char* own : {"localhost:1", "127.0.0.1", "[::1]:8017", "192.0.2.7", "192.0.2.7:80",
                          "render.example", "RENDER.example:99", "other.example:444"}) {
    EXPECT_EQ(check(own), 200) << own;
  }
  for (const char* other : {"192.0.2.8", "other.example", "other.example:445", "render.example.",
                            "xrender.example", "render.example:", "render.example:x", "::1", "[::1",
                            "render.example:123456", "a@render.example", "render.example/"}) {
    EXPECT_EQ(check(other), 403) << other;
  }
  EXPECT_THROW(Guard("127.0.0.1", {"http://render.example"}), std::invalid_argument);
  EXPECT_THROW(Guard("127.0.0.1", {""}), std::invalid_argument);
  EXPECT_EQ(status_of_error([] {
              Guard("127.0.0.1", {}).check(request("GET", "/", {{"host", "192.0.2.7"}}));
            }),
            403);
}

}  // namespace
}  // namespace lacuna
