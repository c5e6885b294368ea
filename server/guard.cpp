#include "server/guard.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace lacuna {
namespace {

bool is_own_host(std::string_view host) {
  constexpr std::array<std::string_view, 3> names{"localhost", "127.0.0.1", "[::1]"};
  return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
    if (!host.starts_with(name)) return false;
    const std::string_view rest = host.substr(name.size());
    return rest.empty() || (rest.size() > 1 && rest.size() < 7 && rest.front() == ':' &&
                            std::all_of(rest.begin() + 1, rest.end(),
                                        [](unsigned char c) { return std::isdigit(c) != 0; }));
  });
}

}  // namespace

void check_sender(const Request& request) {
  const auto host = request.header("host");
  if (!host) throw HttpError(400, "Header Host is missing.");
  if (!is_own_host(*host)) {
    throw HttpError(403, "Header Host names another machine: use localhost, 127.0.0.1 or [::1].");
  }
  const auto origin = request.header("origin");
  const bool safe = request.method == "GET" || request.method == "HEAD";
  if (!safe && origin && *origin != "http://" + *host) {
    throw HttpError(403, "Pages of other sites may not change anything here (header Origin).");
  }
}

}  // namespace lacuna
