#pragma once

#include <string>
#include <string_view>

#include "analysis/json/json_text.h"
#include "server/http/message.h"

namespace lacuna {

/// A JSON answer that nobody may keep.
Response json_response(int status, const OrderedJson& json);
/// The same from JSON text.
Response json_response(int status, std::string text);

/// Adds an ETag, "PREFIX.HASH" with a hash of the answer's text (without `prefix`: "HASH"), and
/// turns the answer into a 304 if the client has that already (If-None-Match).
Response with_tag(const Request& request, Response response, std::string_view prefix = {});

/// What If-Match asks for: the prefix of the one tag in it, "*", or nothing. Throws HttpError 400
/// for anything else.
std::string wanted_revision(const Request& request);

}  // namespace lacuna
