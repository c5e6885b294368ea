#include "server/http/access.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "jobs/spec/described_json.h"

namespace lacuna {
namespace {

constexpr double failures_a_second = 10;
constexpr std::size_t max_session_bytes = 1024;
constexpr const char* session_path = "/api/session";

HttpError token_needed(const char* why) {
  return HttpError(401, why).with("WWW-Authenticate", "Bearer");
}

/// The token of an Authorization header, if any. Throws HttpError 401.
std::optional<std::string> bearer(const Request& request) {
  const auto value = request.header("authorization");
  if (!value) return std::nullopt;
  const std::string scheme = lower_case(value->substr(0, value->find(' ')));
  if (scheme != "bearer" || scheme.size() == value->size()) {
    throw token_needed("Authorization must be \"Bearer TOKEN\".");
  }
  return value->substr(scheme.size() + 1);
}

/// The session's id in the request's cookies; empty if there is none.
std::string session_id(const Request& request) {
  const std::string cookies = request.header("cookie").value_or("");
  for (std::size_t begin = 0; begin < cookies.size();) {
    const std::size_t end = std::min(cookies.find(';', begin), cookies.size());
    std::string_view cookie = std::string_view(cookies).substr(begin, end - begin);
    cookie.remove_prefix(std::min(cookie.find_first_not_of(' '), cookie.size()));
    const std::size_t equals = std::min(cookie.find('='), cookie.size());
    if (cookie.substr(0, equals) == session_cookie && equals < cookie.size()) {
      return std::string(cookie.substr(equals + 1));
    }
    begin = end + 1;
  }
  return {};
}

struct Login {
  std::string token;
};
template <class V>
void describe(V& v, Login& s) {
  v("token", s.token, {.doc = "the service's token", .required = true});
}

/// The "token" of the body.
std::string shown_token(const Request& request) {
  if (media_type(request) != "application/json") {
    throw HttpError(415, "The token is posted with Content-Type: application/json.");
  }
  try {
    return read_document<Login>(request.read_body(max_session_bytes), {max_session_bytes, 1}).token;
  } catch (const BadJob& bad) {
    throw HttpError(400, "The body must be {\"token\": \"...\"}.", bad.problems());
  }
}

Response cookie_answer(const Request& request, const std::string& id, const char* more) {
  // Behind a TLS proxy the cookie is sent over TLS only.
  const bool secure = request.header("origin").value_or("").starts_with("https://");
  Response response;
  response.status = 204;
  response.headers = {
      {"Cache-Control", "no-store"},
      {"Set-Cookie", fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict{}{}", session_cookie, id,
                                 secure ? "; Secure" : "", more)}};
  return response;
}

}  // namespace

Access::Access(const std::string& bind, const AccessSettings& settings,
               std::function<bool(const std::string&)> is_public)
    : guard_(bind, settings.hosts),
      token_(settings.token_file.empty() ? std::nullopt
                                         : std::optional(Token::read(settings.token_file))),
      is_public_(std::move(is_public)),
      tries_(failures_a_second) {}

void Access::admit(const Request& request) {
  guard_.check(request);
  if (!token_ || request.path == session_path) return;
  if (is_safe(request) && (request.path == "/health" || is_public_(request.path))) return;
  if (const auto shown = bearer(request)) return check_token(*shown);
  // An id has 256 random bits and cannot be guessed, so wrong ids need not be counted.
  if (!sessions_.holds(session_id(request))) {
    throw token_needed("A token is needed: Authorization: Bearer TOKEN.");
  }
  guard_.check_own_page(request);
}

void Access::add_to(Router& router) {
  if (!token_) return;
  const RouteDoc of_the_page{.for_programs = false};
  router.add("POST", session_path, of_the_page,
             [this](const Request& r, const Router::Parts&) { return begin_session(r); });
  router.add("DELETE", session_path, of_the_page,
             [this](const Request& r, const Router::Parts&) { return end_session(r); });
}

Response Access::begin_session(const Request& request) {
  check_token(shown_token(request));
  return cookie_answer(request, sessions_.open(), "");
}

Response Access::end_session(const Request& request) {
  const std::string id = session_id(request);
  if (!id.empty()) guard_.check_own_page(request);
  sessions_.close(id);
  return cookie_answer(request, "", "; Max-Age=0");
}

/// The right token always passes, however many wrong ones were sent: it is too long to be guessed
/// at any rate, so the limit protects the service's load, not the secret.
void Access::check_token(std::string_view shown) {
  if (token_->is(shown)) return;
  const std::lock_guard lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - std::exchange(counted_, now)).count();
  tries_ = std::min(failures_a_second, tries_ + failures_a_second * seconds);
  if (tries_ < 1) {
    throw HttpError(429, "Too many wrong tokens have been sent.").with("Retry-After", "1");
  }
  tries_ -= 1;
  throw token_needed("The token is wrong.");
}

}  // namespace lacuna
