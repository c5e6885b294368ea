#include "server/exchange.h"

#include "server/log.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace lacuna {
namespace {

bool is_plain(const std::string& path) {
  return std::all_of(path.begin(), path.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || std::strchr("/._-~", c) != nullptr;
  });
}

}  // namespace

Response respond(const RequestHead& head, BodyReader& body,
                 const std::function<Response(const Request&)>& handler) {
  Request request;
  request.method = head.method;
  request.path = head.target.substr(0, head.target.find('?'));
  request.headers = head.headers;
  request.read_body = [&](std::size_t max_bytes) { return body.text(max_bytes); };
  request.read_body_to = [&](int fd, std::uint64_t max_bytes) {
    return body.to_file(fd, max_bytes);
  };
  try {
    if (!is_plain(request.path)) throw HttpError(404, "There is nothing here.");
    if (request.path.size() < head.target.size()) {
      request.query = Query::parse(std::string_view(head.target).substr(request.path.size() + 1));
    }
    return handler(request);
  } catch (const HttpError& error) {
    return problem_response(error, request.path);
  } catch (const std::exception& error) {
    log::error("{} {}: {}", request.method, request.path, error.what());
    return problem_response(HttpError(500, "The service failed; its log says more."), request.path);
  }
}

}  // namespace lacuna
