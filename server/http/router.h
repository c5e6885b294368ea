#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/json/json_text.h"
#include "server/http/message.h"

namespace lacuna {

/// A query parameter, checked before the handler is called.
struct QueryParameter {
  enum class Type { text, integer, flag };
  std::string name;
  Type type = Type::text;
  std::string doc = {};
  std::int64_t min = INT64_MIN, max = INT64_MAX;  ///< of an integer
};

/// The description of a route, for /openapi.json.
struct RouteDoc {
  std::string summary = {};
  std::vector<QueryParameter> query = {};                 ///< others are refused
  std::vector<std::string> body_types = {};               ///< media types; empty: it takes no body
  std::string body_schema = {};                           ///< JSON Schema, as text; empty: none
  std::vector<std::pair<int, std::string>> answers = {};  ///< status, and what it means
  bool needs_token = true;                                ///< if the service has one
  bool for_programs = true;  ///< false: a file of the page, which takes any query
  /// The parts in braces may contain escapes (%20), which the handler checks; other routes do not
  /// match them.
  bool any_characters = false;
};

/// A table of methods and path patterns such as "/api/jobs/{id}/files/{name}"; each name in braces
/// matches one part of the path, passed to the handler in order. The HTTP library tries the routes
/// in the order in which they were added; HEAD is answered as GET.
class Router {
 public:
  using Parts = std::vector<std::string>;
  using Handler = std::function<Response(const Request&, const Parts&)>;
  struct Route {
    std::string method;
    std::string pattern;
    RouteDoc doc;
    Handler handler;
  };

  void add(std::string method, std::string pattern, RouteDoc doc, Handler handler) {
    routes_.push_back({std::move(method), std::move(pattern), std::move(doc), std::move(handler)});
  }
  /// With no query parameters and no description.
  void add(std::string method, std::string pattern, Handler handler) {
    add(std::move(method), std::move(pattern), {}, std::move(handler));
  }
  const std::vector<Route>& routes() const { return routes_; }
  /// The OpenAPI 3.1 document of all routes for programs. `info`: {"title", "version", ...}. Throws
  /// std::logic_error for a body_schema that is not JSON.
  OrderedJson openapi(const OrderedJson& info) const;

 private:
  std::vector<Route> routes_;
};

/// Throws HttpError 400 for an unknown parameter or an invalid value.
void check_query(const Query& query, const RouteDoc& doc);

/// A handler of a path whose first part is an id: calls `routes`, which must outlive it.
template <class Routes>
Router::Handler with_id(Routes& routes,
                        Response (Routes::*handler)(const Request&, const std::string&)) {
  return [&routes, handler](const Request& request, const Router::Parts& parts) {
    return (routes.*handler)(request, parts[0]);
  };
}

}  // namespace lacuna
