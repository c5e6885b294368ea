#pragma once

#include <functional>

#include "server/body_reader.h"

namespace lacuna {

/// One request, from its head to the handler's answer. An HttpError of the handler becomes a
/// problem+json answer; any other exception is logged and becomes a bare 500. The answer to HEAD
/// still holds its body.
Response respond(const RequestHead& head, BodyReader& body,
                 const std::function<Response(const Request&)>& handler);

}  // namespace lacuna
