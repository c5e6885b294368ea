// Router::openapi(): the table of routes as an OpenAPI 3.1 document.
#include <nlohmann/json.hpp>
#include <utility>

#include "server/http/router.h"
#include "server/http/token.h"

namespace lacuna {
namespace {

OrderedJson path_parameters(const std::string& pattern) {
  OrderedJson result = OrderedJson::array();
  for (std::size_t open = pattern.find('{'); open < pattern.size();) {
    const std::size_t close = pattern.find('}', open);
    result.push_back({{"name", pattern.substr(open + 1, close - open - 1)},
                      {"in", "path"},
                      {"required", true},
                      {"schema", {{"type", "string"}}}});
    open = pattern.find('{', close);
  }
  return result;
}

OrderedJson schema(const QueryParameter& p) {
  if (p.type == QueryParameter::Type::flag) return {{"enum", {"1", "0", "true", "false"}}};
  if (p.type == QueryParameter::Type::text) return {{"type", "string"}};
  OrderedJson result = {{"type", "integer"}};
  if (p.min != INT64_MIN) result["minimum"] = p.min;
  if (p.max != INT64_MAX) result["maximum"] = p.max;
  return result;
}

OrderedJson answers(const RouteDoc& doc) {
  const OrderedJson problem = {
      {"application/problem+json", {{"schema", {{"$ref", "#/components/schemas/Problem"}}}}}};
  OrderedJson result = OrderedJson::object();
  for (const auto& [status, text] : doc.answers) {
    OrderedJson& answer = result[std::to_string(status)];
    answer["description"] = text;
    if (status >= 400) answer["content"] = problem;
  }
  result["default"] = {{"description", "The request is refused."}, {"content", problem}};
  return result;
}

OrderedJson operation(const RouteDoc& doc, OrderedJson parameters) {
  OrderedJson result;
  if (!doc.summary.empty()) result["summary"] = doc.summary;
  for (const QueryParameter& p : doc.query) {
    parameters.push_back(
        {{"name", p.name}, {"in", "query"}, {"description", p.doc}, {"schema", schema(p)}});
  }
  if (!parameters.empty()) result["parameters"] = std::move(parameters);
  if (!doc.body_types.empty()) {
    OrderedJson content = OrderedJson::object();
    for (const std::string& type : doc.body_types) {
      content[type] = OrderedJson::object();
      if (!doc.body_schema.empty()) content[type]["schema"] = parse_own(doc.body_schema);
    }
    result["requestBody"] = {{"required", true}, {"content", std::move(content)}};
  }
  result["responses"] = answers(doc);
  if (!doc.needs_token) result["security"] = OrderedJson::array();
  return result;
}

/// RFC 9457, with positions in a document.
OrderedJson problem_schema() {
  const OrderedJson text = {{"type", "string"}};
  const OrderedJson place = {
      {"type", "object"},
      {"required", {"pointer", "message"}},
      {"properties", {{"pointer", text}, {"message", text}}},
  };
  return {{"type", "object"},
          {"required", {"type", "title", "status", "detail", "instance"}},
          {"properties",
           {{"type", text},
            {"title", text},
            {"status", {{"type", "integer"}}},
            {"detail", text},
            {"instance", text},
            {"errors", {{"type", "array"}, {"items", place}}}}}};
}

}  // namespace

OrderedJson Router::openapi(const OrderedJson& info) const {
  OrderedJson paths = OrderedJson::object();
  for (const Route& route : routes_) {
    if (!route.doc.for_programs) continue;
    paths[route.pattern][lower_case(route.method)] =
        operation(route.doc, path_parameters(route.pattern));
  }
  return {{"openapi", "3.1.0"},
          {"info", info},
          // Only services with a token require it; {} represents the others.
          {"security",
           {OrderedJson::object(),
            {{"token", OrderedJson::array()}},
            {{"session", OrderedJson::array()}}}},
          {"paths", std::move(paths)},
          {"components",
           {{"schemas", {{"Problem", problem_schema()}}},
            {"securitySchemes",
             {{"token", {{"type", "http"}, {"scheme", "bearer"}}},
              {"session", {{"type", "apiKey"}, {"in", "cookie"}, {"name", session_cookie}}}}}}}};
}

}  // namespace lacuna
