#include "server/request_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>

namespace lacuna {
namespace {

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return c != 0 && (std::isalnum(c) != 0 || std::strchr("!#$%&'*+-.^_`|~", c) != nullptr);
  });
}

/// Takes the next line off; throws where it does not end in CR LF.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos || end == 0 || text[end - 1] != '\r') {
    throw HttpError(400, "Lines of a request's head end in CR LF.");
  }
  const std::string_view line = text.substr(0, end - 1);
  text.remove_prefix(end + 1);
  return line;
}

void parse_request_line(std::string_view line, RequestHead& head) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) {
    throw HttpError(400, "The request line is not \"METHOD PATH HTTP/1.1\".");
  }
  head.method = line.substr(0, first);
  head.target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (!is_token(head.method)) throw HttpError(400, "The method is malformed.");
  if (head.target.size() > max_target_bytes) throw HttpError(414, "The address is too long.");
  if (head.target.empty() || head.target.front() != '/' ||
      !std::all_of(head.target.begin(), head.target.end(),
                   [](char c) { return c > ' ' && c < '\x7f'; })) {
    throw HttpError(400, "The address is not a path of printable ASCII, beginning with \"/\".");
  }
  if (version.size() != 8 || !version.starts_with("HTTP/")) {
    throw HttpError(400, "The request line is not \"METHOD PATH HTTP/1.1\".");
  }
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    throw HttpError(505, "Only HTTP/1.1 and HTTP/1.0 are spoken here.");
  }
  head.is_http_1_0 = version == "HTTP/1.0";
  constexpr std::array<std::string_view, 7> methods{"GET",   "HEAD",   "POST",   "PUT",
                                                    "PATCH", "DELETE", "OPTIONS"};
  if (std::find(methods.begin(), methods.end(), head.method) == methods.end()) {
    throw HttpError(501, "The method is not known here.");
  }
}

void parse_header(std::string_view line, Headers& headers) {
  if (line.front() == ' ' || line.front() == '\t') {
    throw HttpError(400, "A header goes on over several lines, which is out of use.");
  }
  const std::size_t colon = line.find(':');
  const std::string_view name = line.substr(0, colon);
  if (colon == std::string_view::npos || !is_token(name)) {
    throw HttpError(400, "A header is not \"Name: value\".");
  }
  std::string_view value = line.substr(colon + 1);
  value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
  value = value.substr(0, value.find_last_not_of(" \t") + 1);
  if (std::any_of(value.begin(), value.end(),
                  [](unsigned char c) { return (c < ' ' && c != '\t') || c == 0x7f; })) {
    throw HttpError(400, "A header holds a control character.");
  }
  headers.emplace(lower_case(name), value);
}

/// Headers of which two lines could be understood in two ways, whoever reads them; of others,
/// single_header() says so when they are used.
void check_once(const Headers& headers) {
  for (const char* name : {"host", "content-length", "transfer-encoding", "content-type",
                           "authorization", "origin", "expect"}) {
    single_header(headers, name);
  }
}

}  // namespace

bool RequestHead::expects_continue() const { return !is_http_1_0 && headers.contains("expect"); }

std::size_t find_head_end(std::string_view received, std::size_t seen) {
  // An empty line ends the head even if its ends of lines are wrong: parse_head() says so, and the
  // client need not run into its deadline.
  std::size_t at = received.find('\n', seen > 2 ? seen - 2 : 0);
  for (; at != std::string_view::npos; at = received.find('\n', at + 1)) {
    std::size_t next = at + 1;
    if (next < received.size() && received[next] == '\r') ++next;
    if (next < received.size() && received[next] == '\n') {
      if (next + 1 > max_head_bytes) break;
      return next + 1;
    }
  }
  if (received.find('\n') == std::string_view::npos && received.size() > 2 * max_target_bytes) {
    throw HttpError(414, "The address is too long.");
  }
  if (received.size() > max_head_bytes) {
    throw HttpError(431, fmt::format("The head is larger than {} bytes.", max_head_bytes));
  }
  return 0;
}

RequestHead parse_head(std::string_view text) {
  RequestHead head;
  parse_request_line(take_line(text), head);
  for (std::string_view line = take_line(text); !line.empty(); line = take_line(text)) {
    if (head.headers.size() == max_headers) {
      throw HttpError(431, fmt::format("There are more than {} headers.", max_headers));
    }
    parse_header(line, head.headers);
  }
  check_once(head.headers);
  const auto expect = single_header(head.headers, "expect");
  if (expect && lower_case(*expect) != "100-continue") {
    throw HttpError(417, "Only \"100-continue\" may be expected.");
  }
  return head;
}

BodyFraming body_framing(const RequestHead& head) {
  const auto encoding = single_header(head.headers, "transfer-encoding");
  const auto length = single_header(head.headers, "content-length");
  if (encoding && length) throw HttpError(400, "Content-Length and Transfer-Encoding together.");
  if (encoding && (lower_case(*encoding) != "chunked" || head.is_http_1_0)) {
    throw HttpError(400, "Transfer-Encoding may only be \"chunked\", and only in HTTP/1.1.");
  }
  if (length && (length->empty() || length->size() > 18 ||
                 length->find_first_not_of("0123456789") != std::string::npos)) {
    throw HttpError(400, "Content-Length is not a number of bytes.");
  }
  return {encoding.has_value(), length ? std::stoull(*length) : 0};
}

}  // namespace lacuna
