#include "server/answer_text.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <stdexcept>

namespace lacuna {
namespace {

// The page holds no foreign content and is nobody's frame. A figure of it in a frame elsewhere is
// not possible: its address says so only behind the #, which the service never sees.
constexpr std::string_view every_answer =
    "Content-Security-Policy: default-src 'self'; img-src 'self' blob: data:; object-src 'none'; "
    "frame-ancestors 'none'; base-uri 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cross-Origin-Resource-Policy: same-origin\r\n"
    "Connection: close\r\n";

void append(std::string& text, std::string_view name, std::string_view value) {
  const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7f; };
  if (std::any_of(value.begin(), value.end(), is_control)) {
    throw std::logic_error(fmt::format("header {} would hold a control character", name));
  }
  text += fmt::format("{}: {}\r\n", name, value);
}

}  // namespace

std::string answer_head(const Response& response, bool to_http_1_0) {
  // HTTP/1.1 is what the service speaks, whatever the client does (RFC 9110, section 2.5).
  std::string text =
      fmt::format("HTTP/1.1 {} {}\r\n", response.status, status_title(response.status));
  append(text, "Date",
         fmt::format("{:%a, %d %b %Y %H:%M:%S} GMT", fmt::gmtime(std::time(nullptr))));
  text += every_answer;
  for (const auto& [name, value] : response.headers) append(text, name, value);
  if (!response.content_type.empty()) append(text, "Content-Type", response.content_type);
  const bool has_no_body = response.status == 204 || response.status == 304;
  if (response.stream) {
    if (!to_http_1_0) text += "Transfer-Encoding: chunked\r\n";
  } else if (!has_no_body) {
    const auto length = response.file ? static_cast<std::uint64_t>(response.file->length)
                                      : std::uint64_t{response.body.size()};
    append(text, "Content-Length", std::to_string(length));
  }
  return text + "\r\n";
}

std::string stream_text(std::string_view text, bool to_http_1_0) {
  if (to_http_1_0) return std::string(text);
  return fmt::format("{:x}\r\n{}\r\n", text.size(), text);
}

}  // namespace lacuna
