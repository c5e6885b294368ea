#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "server/message.h"

namespace lacuna {

/// A table of methods and path patterns such as "/api/jobs/{}/files/{}"; each {} is one part of the
/// path, given to the handler in order. HEAD is answered as GET.
class Router {
 public:
  using Parts = std::vector<std::string>;
  using Handler = std::function<Response(const Request&, const Parts&)>;

  void add(std::string method, std::string_view pattern, Handler handler);
  /// Calls the handler; throws HttpError 404, or 405 with Allow.
  Response route(const Request& request) const;

 private:
  struct Route {
    std::string method;
    Parts pattern;
    Handler handler;
  };
  std::vector<Route> routes_;
};

}  // namespace lacuna
