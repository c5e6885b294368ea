#include "server/http/conditional.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "server/http/file_response.h"

namespace lacuna {

Response json_response(int status, const OrderedJson& json) {
  return json_response(status, document_text(json));
}

Response json_response(int status, std::string text) {
  Response response;
  response.status = status;
  response.content_type = "application/json";
  response.headers = {{"Cache-Control", "no-store"}};
  response.body = std::move(text);
  return response;
}

Response with_tag(const Request& request, Response response, std::string_view prefix) {
  const std::string tag = fmt::format("\"{}{}{:016x}\"", prefix, prefix.empty() ? "" : ".",
                                      XXH3_64bits(response.body.data(), response.body.size()));
  response.headers = {{"Cache-Control", "no-cache"}, {"ETag", tag}};
  if (client_has(request, tag)) {
    response.status = 304;
    response.body.clear();
    response.content_type.clear();
  }
  return response;
}

std::string wanted_revision(const Request& request) {
  const auto header = request.header("if-match");
  if (!header || *header == "*") return header.value_or("");
  std::string_view tag = *header;
  const bool quoted = tag.size() > 2 && tag.front() == '"' && tag.back() == '"';
  if (quoted) tag = tag.substr(1, tag.size() - 2);
  if (!quoted || tag.find('"') != std::string_view::npos) {
    throw HttpError(400, "Header If-Match takes one entity tag in quotation marks, or *.");
  }
  return std::string(tag.substr(0, tag.find('.')));
}

}  // namespace lacuna
