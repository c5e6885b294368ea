#include "server/http/guard.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <stdexcept>
#include <string_view>

namespace lacuna {
namespace {

struct HostPort {
  std::string name;  ///< in lower case; an IPv6 address in brackets
  std::string port;  ///< may be empty
};

/// None if it is not NAME or NAME:PORT.
std::optional<HostPort> parse(std::string_view text) {
  const std::size_t bracket = text.find(']');
  const std::size_t colon = text.find(':', bracket == std::string_view::npos ? 0 : bracket);
  HostPort result{lower_case(std::string(text.substr(0, colon))), {}};
  const bool in_brackets = result.name.starts_with('[') && result.name.ends_with(']');
  const bool fits = std::all_of(result.name.begin(), result.name.end(), [&](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) != 0 || c == '.' || c == '-' ||
                        (in_brackets && (c == ':' || c == '[' || c == ']')));
  });
  if (!fits || result.name.empty()) return std::nullopt;
  if (colon == std::string_view::npos) return result;
  result.port = text.substr(colon + 1);
  const bool is_number = std::all_of(result.port.begin(), result.port.end(),
                                     [](unsigned char c) { return std::isdigit(c) != 0; });
  if (result.port.empty() || result.port.size() > 5 || !is_number) return std::nullopt;
  return result;
}

bool holds(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

}  // namespace

void check_framing(const Request& request) {
  constexpr std::size_t max_digits = 18;  // fit into 64 bits
  const auto encoding = request.header("transfer-encoding");
  const auto length = request.header("content-length");
  if (encoding && length)
    throw HttpError(400, "Content-Length and Transfer-Encoding exclude each other.");
  if (encoding && *encoding != "chunked") {
    throw HttpError(400, "Transfer-Encoding may only be \"chunked\".");
  }
  if (length && (length->size() > max_digits ||
                 length->find_first_not_of("0123456789") != std::string::npos)) {
    throw HttpError(400, "Content-Length is not a number of bytes.");
  }
  if (request.headers.contains("content-encoding")) {
    throw HttpError(415, "An encoded body (Content-Encoding) is not accepted.");
  }
  if (media_type(request).starts_with("multipart/")) {
    throw HttpError(415, "A multipart body is not accepted.");
  }
}

bool is_safe(const Request& request) { return request.method == "GET" || request.method == "HEAD"; }

Guard::Guard(const std::string& bind, const std::vector<std::string>& hosts)
    : names_{"localhost", "127.0.0.1", "[::1]"} {
  const std::string own = bind.find(':') == std::string::npos ? bind : "[" + bind + "]";
  if (const auto host = parse(own); host && !holds(names_, host->name)) {
    names_.push_back(host->name);
  }
  for (const std::string& text : hosts) {
    const auto host = parse(text);
    if (!host) {
      throw std::invalid_argument(
          fmt::format("--host \"{}\" is not a host name; allowed: NAME or NAME:PORT", text));
    }
    if (host->port.empty()) {
      names_.push_back(host->name);
    } else {
      with_ports_.push_back(host->name + ":" + host->port);
    }
  }
}

bool Guard::is_own(const std::string& host) const {
  const auto sent = parse(host);
  return sent && (holds(names_, sent->name) || holds(with_ports_, sent->name + ":" + sent->port));
}

void Guard::check(const Request& request) const {
  const auto host = request.header("host");
  if (!host || host->empty()) throw HttpError(400, "Header Host is missing.");
  if (!is_own(*host)) {
    throw HttpError(403, fmt::format("Header Host is not a name of this service: use {}.",
                                     fmt::join(names_, ", ")));
  }
  const auto origin = request.header("origin");
  // https: behind a TLS proxy.
  const bool own = !origin || *origin == "http://" + *host || *origin == "https://" + *host;
  if (!is_safe(request) && !own) {
    throw HttpError(403, "Pages of other sites may not change anything (header Origin).");
  }
}

void Guard::check_own_page(const Request& request) const {
  if (is_safe(request) || request.header("origin")) return;  // checked by check()
  if (request.header("sec-fetch-site").value_or("") == "same-origin") return;
  throw HttpError(403,
                  "A request with a cookie must say that it comes from a page of this service "
                  "(header Origin or Sec-Fetch-Site).");
}

}  // namespace lacuna
