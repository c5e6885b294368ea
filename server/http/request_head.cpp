#include "server/http/request_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <map>
#include <optional>

#include "server/http/message.h"

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

void check_request_line(std::string_view line) {
  const std::size_t first = line.find(' ');
  const std::size_t last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) {
    throw HttpError(400, "The request line is not \"METHOD PATH HTTP/1.1\".");
  }
  const std::string_view method = line.substr(0, first);
  const std::string_view target = line.substr(first + 1, last - first - 1);
  const std::string_view version = line.substr(last + 1);
  if (!is_token(method)) throw HttpError(400, "The method is malformed.");
  if (target.size() > max_target_bytes) throw HttpError(414, "The address is too long.");
  if (!target.starts_with('/') ||
      !std::all_of(target.begin(), target.end(), [](char c) { return c > ' ' && c < '\x7f'; })) {
    throw HttpError(400, "The address is not a path of printable ASCII, beginning with \"/\".");
  }
  if (target.find('?') != target.rfind('?')) {
    throw HttpError(400, "The address holds a second \"?\": write it as %3F.");
  }
  if (version.size() != 8 || !version.starts_with("HTTP/")) {
    throw HttpError(400, "The request line is not \"METHOD PATH HTTP/1.1\".");
  }
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    throw HttpError(505, "Only HTTP/1.1 and HTTP/1.0 are supported.");
  }
  constexpr std::array<std::string_view, 7> methods{"GET",   "HEAD",   "POST",   "PUT",
                                                    "PATCH", "DELETE", "OPTIONS"};
  if (std::find(methods.begin(), methods.end(), method) == methods.end()) {
    throw HttpError(501, "The method is not supported.");
  }
}

struct Header {
  std::string name;  ///< in lower case
  std::string_view value;
};

Header checked_header(std::string_view line) {
  if (line.front() == ' ' || line.front() == '\t') {
    throw HttpError(400, "A header is continued on several lines, which is obsolete.");
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
  if (value.empty()) {  // the library takes it for absent
    throw HttpError(400, fmt::format("Header {} has no value.", name));
  }
  return {lower_case(name), value};
}

/// "bytes=A-B", "bytes=A-" or "bytes=-N", A not beyond B.
bool is_one_range(std::string_view value) {
  constexpr std::string_view unit = "bytes=";
  constexpr std::size_t max_digits = 18;
  if (!value.starts_with(unit)) return false;
  value.remove_prefix(unit.size());
  const std::size_t dash = value.find('-');
  const auto is_number = [](std::string_view digits) {
    return digits.size() <= max_digits &&
           digits.find_first_not_of("0123456789") == std::string_view::npos;
  };
  if (dash == std::string_view::npos || value.size() == 1) return false;
  const std::string first(value.substr(0, dash)), last(value.substr(dash + 1));
  if (!is_number(first) || !is_number(last)) return false;
  return first.empty() || last.empty() || std::stoull(first) <= std::stoull(last);
}

bool library_gets(const Header& header) {
  if (header.name == "range") return is_one_range(header.value);
  return header.name != "expect" && header.name != "accept-encoding";
}

/// The header's line as the library gets it.
std::string library_line(const Header& header) {
  constexpr std::size_t longest = 8190;  // the library's own limit
  std::string line = header.name + ": ";
  for (const char c : header.value) {
    line += c;
    if (c == '%') line += "25";
  }
  if (line.size() > longest) {
    throw HttpError(431, fmt::format("Header {} is longer than {} bytes.", header.name, longest));
  }
  return line + "\r\n";
}

/// Headers of which two lines could be understood in two ways, whoever reads them; of others,
/// single_header() says so when they are used.
bool may_stand_once(std::string_view name) {
  constexpr std::array<std::string_view, 8> names{
      "host",   "content-length", "transfer-encoding", "content-type", "authorization", "origin",
      "expect", "range"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

using Values = std::map<std::string, std::string_view, std::less<>>;

std::optional<std::string_view> value_of(const Values& values, std::string_view name) {
  const auto found = values.find(name);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

/// Throws HttpError 400 where the headers leave a doubt about how the body is delimited.
void read_framing(const Values& values, bool is_http_1_0, RequestHead& head) {
  const auto encoding = value_of(values, "transfer-encoding");
  const auto length = value_of(values, "content-length");
  if (encoding && length) throw HttpError(400, "Content-Length and Transfer-Encoding together.");
  if (encoding && (lower_case(*encoding) != "chunked" || is_http_1_0)) {
    throw HttpError(400, "Transfer-Encoding may only be \"chunked\", and only in HTTP/1.1.");
  }
  if (length &&
      (length->size() > 18 || length->find_first_not_of("0123456789") != std::string_view::npos)) {
    throw HttpError(400, "Content-Length is not a number of bytes.");
  }
  head.chunked = encoding.has_value();
  head.length = length ? std::stoull(std::string(*length)) : 0;
}

}  // namespace

std::size_t find_head_end(std::string_view received, std::size_t seen) {
  // An empty line ends the head even if its ends of lines are wrong: check_head() says so, and the
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

RequestHead check_head(std::string_view text) {
  RequestHead head;
  const std::string_view request_line = take_line(text);
  check_request_line(request_line);
  const bool is_http_1_0 = request_line.ends_with("1.0");
  head.text = fmt::format("{}\r\n", request_line);
  Values values;
  std::size_t headers = 0;
  for (std::string_view line = take_line(text); !line.empty(); line = take_line(text)) {
    if (++headers > max_headers) {
      throw HttpError(431, fmt::format("There are more than {} headers.", max_headers));
    }
    const Header header = checked_header(line);
    if (!values.emplace(header.name, header.value).second && may_stand_once(header.name)) {
      throw HttpError(400, fmt::format("Header {} is given more than once.", header.name));
    }
    if (library_gets(header)) head.text += library_line(header);
  }
  head.text += "\r\n";
  const auto expect = value_of(values, "expect");
  if (expect && lower_case(*expect) != "100-continue") {
    throw HttpError(417, "Only \"100-continue\" may be expected.");
  }
  head.expects_continue = expect && !is_http_1_0;
  read_framing(values, is_http_1_0, head);
  return head;
}

}  // namespace lacuna
