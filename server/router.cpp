#include "server/router.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace lacuna {
namespace {

Router::Parts split(std::string_view path) {
  Router::Parts parts;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    parts.emplace_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

bool is_placeholder(std::string_view part) { return part.starts_with('{'); }

std::optional<Router::Parts> match(const Router::Parts& pattern, const Router::Parts& path) {
  if (pattern.size() != path.size()) return std::nullopt;
  Router::Parts found;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (is_placeholder(pattern[i]) && !path[i].empty()) {
      found.push_back(path[i]);
    } else if (pattern[i] != path[i]) {
      return std::nullopt;
    }
  }
  return found;
}

void check_query(const Query& query, const std::vector<QueryParameter>& parameters) {
  std::vector<std::string> names;
  names.reserve(parameters.size());
  for (const QueryParameter& p : parameters) names.push_back(p.name);
  query.check_known(names);
  for (const QueryParameter& p : parameters) {
    if (p.type == QueryParameter::Type::integer) query.integer(p.name, p.min, p.max);
    if (p.type == QueryParameter::Type::flag) query.flag(p.name);
  }
}

}  // namespace

void Router::add(std::string method, std::string_view pattern, RouteDoc doc, Handler handler) {
  routes_.push_back({std::move(method), split(pattern), std::move(doc), std::move(handler)});
}

void Router::add(std::string method, std::string_view pattern, Handler handler) {
  add(std::move(method), pattern, RouteDoc{}, std::move(handler));
}

Response Router::route(const Request& request) const {
  const Parts path = split(request.path);
  const std::string method = request.method == "HEAD" ? "GET" : request.method;
  std::string allowed;
  for (const Route& route : routes_) {
    const auto parts = match(route.pattern, path);
    if (!parts) continue;
    if (route.method == method) {
      check_query(request.query, route.doc.query);
      return route.handler(request, *parts);
    }
    if (!allowed.empty()) allowed += ", ";
    allowed += route.method == "GET" ? "GET, HEAD" : route.method;
  }
  if (allowed.empty()) throw HttpError(404, "There is nothing here.");
  throw HttpError(405, fmt::format("{} is not possible here, only {}.", request.method, allowed))
      .with("Allow", allowed);
}

}  // namespace lacuna
