#include "server/http/router.h"

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

}  // namespace

void Router::add(std::string method, std::string_view pattern, RouteDoc doc, Handler handler) {
  routes_.push_back({std::move(method), split(pattern), std::move(doc), std::move(handler)});
}

void Router::add(std::string method, std::string_view pattern, Handler handler) {
  add(std::move(method), pattern, RouteDoc{}, std::move(handler));
}

void check_query(const Query& query, const RouteDoc& doc) {
  std::vector<std::string> names;
  names.reserve(doc.query.size());
  for (const QueryParameter& p : doc.query) names.push_back(p.name);
  query.check_known(names);
  for (const QueryParameter& p : doc.query) {
    if (p.type == QueryParameter::Type::integer) query.integer(p.name, p.min, p.max);
    if (p.type == QueryParameter::Type::flag) query.flag(p.name);
  }
}

}  // namespace lacuna
