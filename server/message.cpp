#include "server/message.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace lacuna {
namespace {

const char* title(int status) {
  switch (status) {
    case 400:
      return "Bad request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not found";
    case 405:
      return "Method not allowed";
    case 408:
      return "Too slow";
    case 409:
      return "Conflict";
    case 413:
      return "Too large";
    case 414:
      return "Address too long";
    case 415:
      return "Unsupported media type";
    case 416:
      return "Range not satisfiable";
    case 503:
      return "Busy";
    case 507:
      return "Cannot store";
    default:
      return "Internal error";
  }
}

}  // namespace

std::optional<std::string> Request::header(const std::string& lower_case_name) const {
  const auto [first, last] = headers.equal_range(lower_case_name);
  if (first == last) return std::nullopt;
  if (std::next(first) != last) {
    throw HttpError(400, fmt::format("Header {} stands more than once.", lower_case_name));
  }
  return first->second;
}

std::optional<std::string> Request::parameter(const std::string& name) const {
  const auto found = query.find(name);
  if (found == query.end()) return std::nullopt;
  return found->second;
}

std::optional<std::int64_t> Request::integer(const std::string& name, std::int64_t min, std::int64_t max) const {
  const auto text = parameter(name);
  if (!text) return std::nullopt;
  return std::clamp<std::int64_t>(std::stoll(*text), min, max);
}

Response problem_response(const HttpError& error, const std::string& path) {
  nlohmann::ordered_json json = {{"type", "about:blank"},
                                 {"title", title(error.status())},
                                 {"status", error.status()},
                                 {"detail", error.what()},
                                 {"instance", path}};
  for (const Problem& p : error.errors()) {
    json["errors"].push_back({{"pointer", p.pointer}, {"message", p.message}});
  }
  Response response;
  response.status = error.status();
  response.content_type = "application/problem+json";
  response.headers = error.headers();
  response.body = json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
  return response;
}

}  // namespace lacuna
