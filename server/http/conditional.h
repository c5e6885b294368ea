#pragma once

#include <string>
#include <string_view>

#include "base/json/json_text.h"
#include "server/http/message.h"

namespace lacuna {

/// A JSON response that may not be cached.
Response json_response(int status, const OrderedJson& json);
/// The same from JSON text.
Response json_response(int status, std::string text);

/// Adds an ETag, "PREFIX.HASH" with a hash of the response's text (without `prefix`: "HASH"), and
/// replaces the response by a 304 if the client already has it (If-None-Match).
Response with_tag(const Request& request, Response response, std::string_view prefix = {});

/// The revision in If-Match: the prefix of its single tag, "*", or empty. Throws HttpError 400 for
/// anything else.
std::string wanted_revision(const Request& request);

}  // namespace lacuna
