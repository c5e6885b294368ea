#include "server/http/message.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <nlohmann/json.hpp>

#include "base/json/json_text.h"
#include "base/storage/passing_error.h"

namespace lacuna {

const char* status_title(int status) {
  using Pair = std::pair<int, const char*>;
  constexpr std::array<Pair, 25> titles{{
      {200, "OK"},
      {201, "Created"},
      {202, "Accepted"},
      {204, "No content"},
      {206, "Partial content"},
      {304, "Not modified"},
      {400, "Bad request"},
      {401, "Token needed"},
      {403, "Forbidden"},
      {404, "Not found"},
      {405, "Method not allowed"},
      {409, "Conflict"},
      {410, "Gone"},
      {412, "Precondition failed"},
      {413, "Too large"},
      {414, "Address too long"},
      {415, "Unsupported media type"},
      {416, "Range not satisfiable"},
      {422, "Unprocessable"},
      {429, "Too many requests"},
      {500, "Internal error"},
      {501, "Not implemented"},
      {503, "Service unavailable"},
      {504, "Out of time"},
      {507, "Insufficient storage"},
  }};
  for (const auto& [number, text] : titles) {
    if (number == status) return text;
  }
  return "Error";
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::optional<std::string> Request::header(const std::string& name) const {
  const auto [first, last] = headers.equal_range(name);
  if (first == last) return std::nullopt;
  if (std::next(first) != last) {
    throw HttpError(400, fmt::format("Header {} is repeated.", name));
  }
  return first->second;
}

bool announces_body(const Request& request) {
  const auto [first, last] = request.headers.equal_range("content-length");
  return request.headers.contains("transfer-encoding") ||
         std::any_of(first, last, [](const auto& header) { return header.second != "0"; });
}

std::string media_type(const Request& request) {
  std::string type = request.header("content-type").value_or("");
  type = type.substr(0, type.find(';'));
  type.erase(type.find_last_not_of(" \t") + 1);
  return lower_case(std::move(type));
}

HttpError storage_error(const std::system_error& error, const std::string& what) {
  const std::string detail = fmt::format("{}: {}.", what, error.code().message());
  if (!is_want_of_descriptors(error.code().value())) return HttpError(507, detail);
  return HttpError(503, detail).with("Retry-After", "1");
}

Response problem_response(const HttpError& error, const std::string& path) {
  OrderedJson json = {{"type", "about:blank"},
                      {"title", status_title(error.status())},
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
  response.body = document_text(json);
  return response;
}

}  // namespace lacuna
